#pragma once

#include "quorient/runtime/yaml.hpp"
#include "quorient/system/system.hpp"

namespace quorient::system {

/// `lanes[].detector`: the method on axes, or the observers of a vessel, and the verdict behind both. A detector that this unit cannot have
/// is a mistake of the file, told at the lane's key before anything starts.
void parse_detector(runtime::Section& lane, const System& system, DetectorProcess& detector);

}  // namespace quorient::system
