#pragma once

#include "quorient/messages/exclusions.hpp"
#include "quorient/messages/limits.hpp"
#include "quorient/messages/stamps.hpp"

#include <array>
#include <cstdint>

namespace quorient {

/// All that a detector holds true of its cluster at one frame. A complete state: the newest identity wins, so the order and
/// the repetition of verdicts cannot matter.
struct FaultVerdict {
    std::uint64_t epoch = 0;
    std::uint64_t sequence = 0;
    std::int64_t sample_time_ns = 0;
    Exclusions excluded_from;                 ///< for isolated axes, and for those left out provisionally
    double statistic = 0;                                                     ///< the method's, and its threshold in the same unit
    double threshold = 0;
    std::array<double, max_axes> residual{};  ///< [rad; m/s]
    std::array<double, max_axes> bound{};     ///< what the residual stays below while the axis is healthy, same unit
    Stamps stamp_ns{};
    std::uint32_t unit = 0;
    std::uint32_t detector = 0;
    std::uint32_t isolated_mask = 0;
    std::uint32_t suspect_mask = 0;
    std::array<std::uint32_t, max_candidates> candidate_set{};
    std::uint32_t working_mask = 0;
    std::uint8_t kind = 0;   ///< SensorKind
    std::uint8_t state = 0;  ///< VerdictState
    std::uint8_t candidate_count = 0;
    std::uint8_t candidates_truncated = 0;
    std::uint8_t detectable_remaining = 0;  ///< how many further faults can be detected with the axes that are left
    std::uint8_t adopted = 0;               ///< the exclusions were taken over from the lane after a restart
    std::array<std::uint8_t, 6> padding{};
};

}  // namespace quorient
