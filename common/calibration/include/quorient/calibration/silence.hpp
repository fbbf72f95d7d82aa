#pragma once

#include "quorient/calibration/calibration.hpp"

#include <array>
#include <string_view>

namespace quorient::calibration {

/// What a replay of the recording isolates with its own calibration, everything switched on that a replay takes from it.
struct Replayed {
    std::string_view method;
    AxisMask isolated = 0;
    double first_s = 0;  ///< since the log's begin
};

struct Silence {
    std::array<Replayed, 2> replayed;  ///< by `field` and by `accumulating`, the final level
    bool at_limit = false;             ///< accumulating isolates a sound instrument even at the largest level
};

/// Replays the recording. As long as `accumulating` isolates an instrument without an axis that was set aside, raises the level of the motion
/// noise and with it the terms of the gated sums. Where an axis was set aside, the level stays. [docs/methods/calibration.md]
/// @returns nothing where the detectors do not accept the array.
std::optional<Silence> make_silent(Samples samples, Calibration& calibration);

}  // namespace quorient::calibration
