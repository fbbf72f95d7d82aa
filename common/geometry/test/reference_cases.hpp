#pragma once

#include "quorient/geometry/sensor_cluster.hpp"

#include <gtest/gtest.h>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

namespace quorient::test {

/// The worked cases of one method; nothing where the shared folder is absent.
inline std::optional<std::vector<nlohmann::json>> reference_cases(const std::string& method)
{
    const char* folder = std::getenv("QUORIENT_SHARED_DIR");
    const auto shared = folder ? std::filesystem::path(folder) : std::filesystem::path(QUORIENT_SOURCE_DIR) / ".." / "shared";
    std::ifstream file(shared / "reference" / "cases.json");
    if (!file) return std::nullopt;
    const auto all = nlohmann::json::parse(file);
    std::vector<nlohmann::json> found;
    for (const auto& one : all["cases"])
        if (one["method"] == method) found.push_back(one);
    return found;
}

inline geometry::AxisMatrix matrix_of(const nlohmann::json& rows)
{
    geometry::AxisMatrix matrix(rows.size(), rows.empty() ? 0 : rows[0].size());
    for (Eigen::Index i = 0; i < matrix.rows(); ++i)
        for (Eigen::Index j = 0; j < matrix.cols(); ++j)
            matrix(i, j) = rows[static_cast<std::size_t>(i)][static_cast<std::size_t>(j)].get<double>();
    return matrix;
}

inline geometry::AxisVector vector_of(const nlohmann::json& list)
{
    geometry::AxisVector vector(list.size());
    for (Eigen::Index i = 0; i < vector.size(); ++i) vector(i) = list[static_cast<std::size_t>(i)].get<double>();
    return vector;
}

}  // namespace quorient::test

/// Skips a test where reference_cases() found no file, and fails it where the file has none of that method.
#define QUORIENT_SKIP_WITHOUT(cases)                                                                                                    \
    do {                                                                                                                                \
        if (!(cases)) GTEST_SKIP() << "no reference cases: set QUORIENT_SHARED_DIR to the folder that holds reference/cases.json";     \
        ASSERT_FALSE((cases)->empty());                                                                                                 \
    } while (false)
