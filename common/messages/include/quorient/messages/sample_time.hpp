#pragma once

#include <cstdint>

namespace quorient {

/// Sample times are within 146 years of the origin of their clock [ns], so that a difference of two of them is always a number.
inline bool is_sample_time(std::int64_t sample_time_ns)
{
    constexpr std::int64_t farthest_ns = std::int64_t{1} << 62;
    return sample_time_ns > -farthest_ns && sample_time_ns < farthest_ns;
}

}  // namespace quorient
