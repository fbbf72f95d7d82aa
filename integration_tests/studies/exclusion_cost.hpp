#pragma once

#include "recorded_array.hpp"

#include <vector>

namespace quorient::studies {

/// How far the attitude turns away where a sound instrument is left out of some frames in violent motion and no other is touched: the least
/// that an onset wrong by so many frames costs, whatever method estimates it.
struct ExclusionCost {
    std::size_t array = 0;
    std::size_t frames = 0;  ///< that it is left out of
    double median_rad = 0;   ///< over all instruments and all beginnings in the longest stretch of motion
    double ninth_decile_rad = 0;
    double share_above_free = 0;  ///< share of cases above the 0.1 deg that the attitude's bound allows for
};

std::vector<ExclusionCost> exclusion_costs(const std::vector<RecordedArray>& arrays);

}  // namespace quorient::studies
