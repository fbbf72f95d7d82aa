#pragma once

#include "program.hpp"
#include "quorient/geometry/sensor_cluster.hpp"

#include <string>
#include <tl/expected.hpp>

namespace quorient::cli {

/// What a user names where a verb needs axes: a layout of the catalogue or a file of unit vectors (rows of x, y, z; .yaml: see system::load_axes_file).
struct ClusterChoice {
    std::string layout;
    std::string axes_file;

    const std::string& name() const { return axes_file.empty() ? layout : axes_file; }
};

/// Adds `--layout NAME` and `--axes FILE`, which exclude each other.
void add_cluster_options(Verb& verb, ClusterChoice& choice);

/// The cluster of the choice. @returns what is wrong, for a file as `file:line:column: what` where a row is to blame.
tl::expected<geometry::SensorCluster, std::string> load_cluster(const ClusterChoice& choice);

}  // namespace quorient::cli
