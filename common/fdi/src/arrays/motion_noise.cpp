#include "quorient/fdi/array_sums.hpp"

#include <cmath>

namespace quorient::fdi {

MotionNoise usual_motion_noise(const geometry::SensorCluster& cluster, double level)
{
    const double rate_sigma = std::sqrt((cluster.sigma.cwiseAbs2() + cluster.quantum.cwiseAbs2() / 6).mean()) / cluster.interval_s;
    return {.jitter_along_s = level * 0.0084 * cluster.interval_s,
            .jitter_across_s = level * 0.0046 * cluster.interval_s,
            .roughness_s = level * 0.028 * cluster.interval_s,
            .axes_error = level * 6e-4,
            .rate_error = level * 1e-4,
            .bias_floor_rad_s = 0.16 * rate_sigma};
}

}  // namespace quorient::fdi
