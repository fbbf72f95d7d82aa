#pragma once

namespace quorient::fdi::field {

/// Standard deviations of a rate, and of its derivative in units of noise per interval, below which they are noise and no motion. Noise of the
/// rate correlates with that of the residuals, which are made of the same samples: as a regressor it would be taken for a gain.
inline constexpr double rate_dead_zone = 5;
inline constexpr double acceleration_dead_zone = 0.7 * rate_dead_zone;

/// 0 up to the limit, and from there on continuously to the value itself: x (1 - limit^2 / x^2).
constexpr double dead_zone(double x, double limit)
{
    return x * x > limit * limit ? x * (1 - limit * limit / (x * x)) : 0;
}

}  // namespace quorient::fdi::field
