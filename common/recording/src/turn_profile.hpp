#pragma once

#include <cstddef>
#include <vector>

namespace quorient::recording {

/// Rates of turn at the points of a grid of times. Their size is the same in every mounting, so they show whether logs are of one motion.
using Profile = std::vector<double>;
inline constexpr double grid_s = 0.01;
inline constexpr std::size_t half_window = 5;  // grid points: averaging over 0.1 s keeps manoeuvres and drops aliased vibration

/// Logs whose profiles correlate less show different motions. The flights at hand: above 0.99 with each other, at most 0.25 across.
inline constexpr double same_motion_correlation = 0.7;

}  // namespace quorient::recording
