#pragma once

#include "quorient/geometry/sensor_cluster.hpp"

#include <string>
#include <tl/expected.hpp>

namespace quorient::system {

/// Axes from a YAML file: what `quorient design --out` writes (`axes: [[x, y, z], …]`, and `instrument: [0, 0, 0, 1, …]` where instruments
/// have several axes), or the cluster file of `quorient calibrate`.
/// @returns what is wrong, with file:line:column where a line is to blame.
tl::expected<geometry::SensorCluster, std::string> load_axes_file(const std::string& file);

}  // namespace quorient::system
