#include "quorient/system/calibrated_noise.hpp"

namespace quorient::system {

std::optional<fdi::GatedNoise> gated_noise_of(const calibration::CalibratedCluster& cluster)
{
    if (!cluster.gated) return std::nullopt;
    return fdi::GatedNoise{.jitter_along_s = cluster.gated->along_s,
                           .jitter_across_s = cluster.gated->across_s,
                           .axes_error = cluster.gated->axes,
                           .rate_error = cluster.gated->rate};
}

}  // namespace quorient::system
