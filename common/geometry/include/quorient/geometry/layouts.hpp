#pragma once

#include "quorient/geometry/sensor_cluster.hpp"

#include <string>
#include <string_view>
#include <tl/expected.hpp>
#include <vector>

namespace quorient::geometry {

/// A layout of the catalogue by its name (exact constructions, not rounded decimals), or one of the families
/// `cone-N`, `cone-axis-N`, `two-cones:A1,A2,D`, `two-triads:ax,ay,az,deg`, `triads-N`. A named entry wins over its family.
/// @returns an error that suggests the nearest name.
tl::expected<SensorCluster, std::string> layout(std::string_view name);

struct CatalogueEntry {
    std::string name;
    std::string source;  ///< paper and matrix
};

/// All named layouts, then the families.
std::vector<CatalogueEntry> catalogue();

}  // namespace quorient::geometry
