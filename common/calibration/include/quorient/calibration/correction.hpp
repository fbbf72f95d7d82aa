#pragma once

#include "quorient/messages/cluster_description.hpp"
#include "quorient/messages/limits.hpp"

#include <array>
#include <cstddef>

namespace quorient::calibration {

/// Makes corrected increments of raw ones, and raw ones of corrected: increment = (raw - bias interval) / gain.
struct Correction {
    std::array<double, max_axes> bias_rad_s{};
    std::array<double, max_axes> gain{};

    /// Raw increments stay as they are.
    static Correction none()
    {
        Correction correction;
        correction.gain.fill(1);
        return correction;
    }

    double corrected(std::size_t axis, double increment, double interval_s) const
    {
        return (increment - bias_rad_s[axis] * interval_s) / gain[axis];
    }
    /// The same of a raw rate. Its rounding is not that of corrected(): the searches of a calibration feel the last bit, so it is kept.
    double increment_of_rate(std::size_t axis, double rate_rad_s, double interval_s) const
    {
        return (rate_rad_s - bias_rad_s[axis]) * interval_s / gain[axis];
    }
    double raw(std::size_t axis, double corrected, double interval_s) const { return corrected * gain[axis] + bias_rad_s[axis] * interval_s; }
};

/// Whether what a publisher describes are these very sensors with this very calibration: axes and noise are the calibration's, to the last bit.
inline bool is_corrected(const ClusterDescription& published, const ClusterDescription& calibrated)
{
    return published.axis_count == calibrated.axis_count && published.axis == calibrated.axis && published.sigma == calibrated.sigma;
}

}  // namespace quorient::calibration
