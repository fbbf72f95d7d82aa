#pragma once

#include "quorient/calibration/sample.hpp"
#include "quorient/fdi/settings.hpp"
#include "quorient/calibration/held_out.hpp"

#include <vector>

namespace quorient::studies {

using calibration::HeldOut;

/// What the accumulating detector makes of parts of a recording with some motion noise.
struct Standing {
    double smallest_step_rad_s = 0;  ///< detectable: geometric mean over axes, moments, and windows of 1 to 512 frames
    double largest_statistic = 0;    ///< 1 = suspicious
};

Standing standing(calibration::Samples samples, const std::vector<HeldOut>& parts, const fdi::MotionNoise& noise);

/// The tightest noise that keeps the detector silent. Candidates are the noises with which the statistic stays below 0.85 of its threshold
/// while the array moves (the limit of calibration::motion_level). The result is a candidate with which the smallest detectable step is
/// smallest. It is a local minimum: a pattern search over the logarithms of the terms, down to factors of 1.35, from `start` on. The bias
/// floor is not searched, because one recording does not show how biases drift from one day to the next.
fdi::MotionNoise tightest_silent(calibration::Samples samples, const std::vector<HeldOut>& parts, const fdi::MotionNoise& start);

}  // namespace quorient::studies
