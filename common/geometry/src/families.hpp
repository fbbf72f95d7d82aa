#pragma once

#include "quorient/geometry/sensor_cluster.hpp"

#include <optional>
#include <string>
#include <string_view>
#include <tl/expected.hpp>
#include <vector>

namespace quorient::geometry {

/// Axes evenly spread from azimuth 0 over a cone around z.
/// @param cosine  of the half-angle between the cone's axis and its generators
Axes cone(Eigen::Index count, double cosine);

struct Family {
    std::string_view prefix;
    std::string_view pattern;
    std::string_view source;
};

const std::vector<Family>& families();

/// Nothing where the name belongs to no family; an error where it does and its parameters do not make a cluster.
std::optional<tl::expected<SensorCluster, std::string>> family_member(std::string_view name);

}  // namespace quorient::geometry
