#pragma once

#include "quorient/runtime/yaml.hpp"
#include "quorient/system/system.hpp"

namespace quorient::system {

/// `unit` of kind vessel_rates: the plant that the observers believe in, and its channels' names.
void parse_vessel_unit(runtime::Section& unit, System& system);

/// `source` of such a unit: a simulation of it under a rudder.
void parse_vessel_source(runtime::Section& source, System& system);

}  // namespace quorient::system
