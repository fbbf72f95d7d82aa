#pragma once

#include "quorient/geometry/sensor_cluster.hpp"

#include <string>

namespace quorient::cli {

/// A picture of an array as an SVG file that stands for itself: its axes from the side and along z, the directions in which their faults
/// show in parity space (where it has two or three dimensions), and how alike these are for every two axes.
std::string array_picture(const geometry::SensorCluster& cluster, const std::string& title);

}  // namespace quorient::cli
