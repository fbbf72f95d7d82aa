#pragma once

#include "quorient/calibration/calibration.hpp"

#include <optional>

namespace quorient::calibration {

/// What the search for a level ended with.
struct MotionLevel {
    double level = 1;
    bool at_limit = false;  ///< the search ended at its upper bound: the statistic is larger than wanted still
};

/// Factor on fdi::usual_motion_noise for this array: with it the statistic of the accumulating detector stays at 0.85 of the threshold over
/// the calibrated recording, gated sums left out. Never below 1, because a recording of gentle motion shows nothing of a violent one.
/// Instruments with an axis that was set aside do not count. [docs/methods/calibration.md]
/// @returns nothing where the detector does not accept the array, or the recording has no motion.
std::optional<MotionLevel> motion_level(Samples samples, const Calibration& calibration);

}  // namespace quorient::calibration
