#pragma once

#include "test_clusters.hpp"

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

namespace quorient::fdi {

/// The worked cases of one family, or none where the reference folder is absent.
inline std::vector<nlohmann::json> reference_cases(const std::string& family)
{
    const char* shared = std::getenv("QUORIENT_SHARED_DIR");
    const std::filesystem::path folder =
        shared != nullptr ? std::filesystem::path(shared) : std::filesystem::path(QUORIENT_SOURCE_DIR) / ".." / "shared";
    std::ifstream file(folder / "reference" / "cases.json");
    std::vector<nlohmann::json> found;
    if (!file) return found;
    const auto all = nlohmann::json::parse(file);
    for (const auto& entry : all["cases"])
        if (entry["method"] == family) found.push_back(entry);
    return found;
}

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

#define QUORIENT_SKIP_WITHOUT(cases) \
    if ((cases).empty()) GTEST_SKIP() << "no reference cases: set QUORIENT_SHARED_DIR to the folder that holds reference/cases.json"
