#pragma once

#include <algorithm>

namespace quorient {

/// A publisher that restarts is silent for at least this long: before that, frames of another epoch are a second publisher's.
inline constexpr double least_restart_silence_s = 0.1;

/// Likewise, where `interval_s` lies between its frames.
constexpr double restart_silence_s(double interval_s)
{
    constexpr double intervals = 5;
    return std::max(intervals * interval_s, least_restart_silence_s);
}

}  // namespace quorient
