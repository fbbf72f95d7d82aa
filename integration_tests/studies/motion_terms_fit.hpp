#pragma once

#include "quorient/calibration/sample.hpp"
#include "quorient/fdi/motion_noise.hpp"
#include "quorient/calibration/held_out.hpp"

#include <vector>

namespace quorient::studies {

using calibration::HeldOut;

/// What the accumulating detector makes of parts of a recording with some motion noise.
struct Standing {
    double smallest_step_rad_s = 0;  ///< that it can tell: geometric mean over axes, over moments, and over windows of 1 to 512 frames
    double largest_statistic = 0;    ///< 1 = suspicious
};

Standing standing(calibration::Samples samples, const std::vector<HeldOut>& parts, const fdi::MotionNoise& noise);

/// The tightest noise that keeps the detector silent: of all noises with which it comes no nearer to its threshold than 0.85 while the
/// array moves (the limit of calibration::motion_level), one with which the smallest step that it can tell is smallest. A pattern search over the
/// logarithms of all terms but the bias floor (what biases drift from one day to the next is not in one recording), down to
/// factors of 1.35, from `start` on: a local minimum.
fdi::MotionNoise tightest_silent(calibration::Samples samples, const std::vector<HeldOut>& parts, const fdi::MotionNoise& start);

}  // namespace quorient::studies
