#pragma once

#include "cli/json_output.hpp"
#include "quorient/geometry/sensor_cluster.hpp"

#include <string>

namespace quorient::cli {

/// All figures of a cluster with some axes left out, in the fields of the verb's contract (docs/command-line.md); undefined ones are null.
/// Axes and instruments keep their numbers: `axis` has those of the rows where some are left out.
Json layout_json(const std::string& name, const geometry::SensorCluster& cluster, AxisMask used);

/// The same to read.
std::string layout_text(const std::string& name, const geometry::SensorCluster& cluster, AxisMask used);

}  // namespace quorient::cli
