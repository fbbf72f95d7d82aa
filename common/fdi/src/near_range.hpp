#pragma once

#include <cmath>

namespace quorient::fdi {

/// Whether an axis is within 2.5 % of the end of its range, or beyond it: what it reports may be less than there was.
/// @param increment  rad or m/s, over interval_s  @param range  rad/s or m/s^2; 0: unknown, nothing is near it
inline bool is_near_range(double increment, double range, double interval_s)
{
    const double limit = range * interval_s;
    return limit > 0 && std::abs(increment) >= 0.975 * limit;
}

}  // namespace quorient::fdi
