#pragma once

#include "quorient/calibration/calibration.hpp"

#include <optional>

namespace quorient::calibration {

/// How wild an array's disagreement in motion is beside the usual (fdi::usual_motion_noise): the level at which the accumulating detector,
/// played over the very recording that the calibration is of, comes no nearer to its threshold than 0.85. Never below 1: a recording of
/// gentle motion says nothing of a violent one.
/// @returns nothing where the array is not one that the detector takes, or the recording is of rest alone.
std::optional<double> motion_level(Samples samples, const Calibration& calibration);

}  // namespace quorient::calibration
