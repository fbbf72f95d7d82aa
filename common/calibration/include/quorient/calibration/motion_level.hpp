#pragma once

#include "quorient/calibration/calibration.hpp"

#include <optional>

namespace quorient::calibration {

/// Factor on fdi::usual_motion_noise for this array: with it the statistic of the accumulating detector stays at 0.85 of the threshold over
/// the calibrated recording. Never below 1, because a recording of gentle motion shows nothing of a violent one.
/// [docs/methods/calibration.md]
/// @returns nothing where the detector does not accept the array, or the recording has no motion.
std::optional<double> motion_level(Samples samples, const Calibration& calibration);

}  // namespace quorient::calibration
