#pragma once

#include "quorient/runtime/yaml.hpp"
#include "quorient/system/system.hpp"

namespace quorient::system {

/// `unit` and `source`: what is measured and by which axes.
void parse_unit(runtime::Section unit, System& system);
void parse_source(runtime::Section source, System& system);

}  // namespace quorient::system
