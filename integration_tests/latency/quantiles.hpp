#pragma once

#include <algorithm>
#include <cstdint>
#include <nlohmann/json.hpp>
#include <vector>

namespace quorient::latency {

/// p50, p90, p99, p99.9 and the largest, in microseconds.
inline nlohmann::json quantiles_us(std::vector<std::int64_t> samples_ns)
{
    if (samples_ns.empty()) return nullptr;
    std::ranges::sort(samples_ns);
    const auto at = [&](double q) {
        return static_cast<double>(samples_ns[static_cast<std::size_t>(q * static_cast<double>(samples_ns.size() - 1))]) * 1e-3;
    };
    return {{"p50", at(0.5)}, {"p90", at(0.9)}, {"p99", at(0.99)}, {"p99.9", at(0.999)}, {"max", at(1)}, {"count", samples_ns.size()}};
}

}  // namespace quorient::latency
