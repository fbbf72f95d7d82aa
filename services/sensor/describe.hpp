#pragma once

#include "quorient/geometry/sensor_cluster.hpp"
#include "quorient/messages/cluster_description.hpp"

namespace quorient::sensor {

/// The description of a cluster as it goes on the wire; names, identity and attitude are the caller's to fill.
ClusterDescription describe(const geometry::SensorCluster& cluster);

}  // namespace quorient::sensor
