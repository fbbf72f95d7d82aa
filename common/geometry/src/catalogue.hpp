#pragma once

#include "quorient/geometry/sensor_cluster.hpp"

#include <string_view>
#include <vector>

namespace quorient::geometry {

struct NamedLayout {
    std::string_view name;
    std::string_view source;
    Axes (*axes)();
    std::vector<std::size_t> instrument{};  ///< empty: every axis its own
};

/// In the order of the catalogue.
const std::vector<NamedLayout>& named_layouts();

}  // namespace quorient::geometry
