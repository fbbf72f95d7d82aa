#pragma once

#include "quorient/runtime/yaml.hpp"
#include "quorient/system/system.hpp"

namespace quorient::system {

/// `ros2:` of the file, for every voter.
void parse_ros2_output(runtime::Section& root, System& system);

/// `source: {kind: ros2_imu, …}`: its IMUs become the unit's cluster.
void parse_ros2_source(runtime::Section& source, System& system);

}  // namespace quorient::system
