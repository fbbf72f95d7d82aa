#pragma once

#include "quorient/calibration/calibration.hpp"

#include <optional>

namespace quorient::calibration {

/// The terms of the accumulating detector's gated sums that a recording shows: in each window of 8 to 512 frames, over both halves of its
/// motion (each played with the calibration of the other), the tenth largest chi-square is at most what that many of them should show;
/// among such terms, some with which the smallest step that the sums can tell is smallest (a pattern search over their logarithms: a
/// local minimum). An order statistic and not the largest one: the worst frames are what the gate is for.
/// @returns nothing where the recording never turned violently enough to tell, half of its motion is not enough for a calibration, or the
/// detector does not take the array.
std::optional<fdi::GatedNoise> gated_terms(Samples samples, const ClusterDescription& nominal,
                                                   const Calibration& calibration,
                                                   const RestSettings& settings = {});

}  // namespace quorient::calibration
