#pragma once

#include "../../geometry/test/reference_cases.hpp"
#include "test_clusters.hpp"

#include <nlohmann/json.hpp>

namespace quorient::fdi {

using quorient::test::reference_cases;

inline geometry::SensorCluster cluster_of(const nlohmann::json& rows)
{
    geometry::Axes axes(static_cast<Eigen::Index>(rows.size()), 3);
    for (std::size_t row = 0; row < rows.size(); ++row)
        for (std::size_t column = 0; column < 3; ++column)
            axes(static_cast<Eigen::Index>(row), static_cast<Eigen::Index>(column)) = rows[row][column].get<double>();
    return geometry::make_cluster(axes).value();
}

/// 1-based sensor numbers of the papers.
inline AxisMask mask_of(const nlohmann::json& sensors)
{
    AxisMask mask = 0;
    for (const auto& sensor : sensors) mask |= axis_bit(sensor.get<std::size_t>() - 1);
    return mask;
}

}  // namespace quorient::fdi
