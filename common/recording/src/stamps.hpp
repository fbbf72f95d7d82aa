#pragma once

#include "quorient/messages/sample_time.hpp"

#include <cmath>
#include <cstdint>
#include <optional>

namespace quorient::recording {

inline constexpr std::int64_t longest_step_ns = 30'000'000'000;  // beyond it a step is a hole, or another epoch

inline double seconds_of(std::int64_t ns)
{
    return static_cast<double>(ns) * 1e-9;
}

/// A log's time in nanoseconds; nothing if it is no sample time (not finite, or more than 146 years).
inline std::optional<std::int64_t> log_time_ns(double value, double unit_ns)
{
    constexpr double beyond_any_ns = 9e18;
    const double ns = value * unit_ns;
    if (!(std::abs(ns) < beyond_any_ns)) return std::nullopt;
    const std::int64_t time_ns = std::llround(ns);
    return is_sample_time(time_ns) ? std::optional(time_ns) : std::nullopt;
}

}  // namespace quorient::recording
