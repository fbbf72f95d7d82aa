#pragma once

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

namespace quorient::simulation {

inline std::filesystem::path shared_dir()
{
    const char* const given = std::getenv("QUORIENT_SHARED_DIR");
    return given != nullptr ? std::filesystem::path(given) : std::filesystem::path(QUORIENT_SOURCE_DIR) / ".." / "shared";
}

/// The worked cases of one family; empty where the file is absent.
inline std::vector<nlohmann::json> reference_cases(const std::string& method)
{
    std::vector<nlohmann::json> cases;
    std::ifstream file(shared_dir() / "reference" / "cases.json");
    if (!file) return cases;
    const auto all = nlohmann::json::parse(file);
    for (const auto& one : all.at("cases"))
        if (one.at("method") == method) cases.push_back(one);
    return cases;
}

}  // namespace quorient::simulation
