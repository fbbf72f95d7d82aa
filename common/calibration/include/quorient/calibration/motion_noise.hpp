#pragma once

#include "quorient/calibration/sample.hpp"

#include <functional>
#include <vector>

namespace quorient::calibration {

/// What the axes' disagreement grows with when the cluster moves: as if each instrument sampled at its own, jittering time.
/// Covariance of an axis h under the angular acceleration a: s0^2 + along_s^2 (h'a)^2 + across_s^2 (|a|^2 - (h'a)^2).
/// [docs/methods/calibration.md]
struct SamplingJitter {
    double along_s = 0;
    double across_s = 0;
    double largest_acceleration_rad_s2 = 0;  ///< in the samples of the estimate
    std::size_t samples = 0;
};

/// Disagreement at one level of angular acceleration, for a plot.
struct DisagreementBin {
    double acceleration_rad_s2 = 0;
    double residual_rad_s = 0;  ///< rms per axis, corrected for the fit's own share
    std::size_t samples = 0;
};

/// Disagreement after averaging: how much of it is noise and how much stays.
struct WindowResidual {
    std::size_t frames = 0;
    double residual_rad_s = 0;  ///< rms per axis of the window's mean residual
    std::size_t windows = 0;
};

struct MotionFigures {
    SamplingJitter noise;
    std::vector<DisagreementBin> bins;
    std::vector<WindowResidual> windows;
};

/// What a sample's rates are to a fit: without bias, perhaps of some axes only, perhaps divided by the gains.
using RateOf = std::function<geometry::AxisVector(const Sample&)>;

/// @param rate_of    without bias, divided by the gains
/// @param usable     one per sample; where it is false the sample is passed over.
/// @param deviation  standard deviation of one sample at rest, per axis, likewise divided by the gains.
MotionFigures motion_figures(Samples samples, const RateOf& rate_of, const std::vector<bool>& usable, const geometry::Axes& axes,
                             const geometry::AxisVector& deviation);

}  // namespace quorient::calibration
