#pragma once

#include "quorient/calibration/calibration.hpp"

#include <optional>

namespace quorient::calibration {

/// The terms of the accumulating detector's gated sums, from a recording.
///
/// Condition: in each window of 8 to 512 frames, over both halves of the motion (each played with the calibration of the other), the tenth
/// largest chi-square is at most its expected value. Among such terms a pattern search over their logarithms takes those with the smallest
/// detectable step (a local minimum). An order statistic decides, not the largest value: the gate is for the worst frames.
/// [docs/methods/calibration.md]
/// @returns nothing where the recording never turned violently enough, an axis was set aside, half of its motion is not enough for a calibration, or the detector
/// does not accept the array.
std::optional<fdi::MotionNoise> gated_terms(Samples samples, const ClusterDescription& nominal,
                                                   const Calibration& calibration,
                                                   const RestSettings& settings = {});

}  // namespace quorient::calibration
