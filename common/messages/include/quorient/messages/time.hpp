#pragma once

#include <cmath>
#include <cstdint>

namespace quorient {

inline constexpr std::int64_t second_ns = 1'000'000'000;

/// The nearest whole nanosecond. |seconds| below 9.2e9.
inline std::int64_t nanoseconds(double seconds)
{
    return std::llround(seconds * 1e9);
}

inline double seconds(std::int64_t nanoseconds)
{
    return static_cast<double>(nanoseconds) * 1e-9;
}

}  // namespace quorient
