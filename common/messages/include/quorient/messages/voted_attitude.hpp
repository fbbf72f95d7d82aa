#pragma once

#include "quorient/messages/exclusions.hpp"
#include "quorient/messages/limits.hpp"
#include "quorient/messages/stamps.hpp"

#include <array>
#include <cstdint>

namespace quorient {

/// The one attitude that the system stands for: the primary lane's, never an average.
struct VotedAttitude {
    std::uint64_t epoch = 0;
    std::uint64_t sequence = 0;
    std::int64_t sample_time_ns = 0;
    std::uint64_t output_sequence = 0;                 ///< strictly increasing, also across voters and epochs
    std::array<double, 4> attitude{1, 0, 0, 0};        ///< q_RB, body -> reference, Hamilton (w,x,y,z)
    std::array<double, 4> reset_rotation{1, 0, 0, 0};  ///< q_new o conj(q_old) of the latest reset
    std::array<double, 3> rate_rad_s{};                ///< body frame
    double angle_sigma_rad = 0;
    double spread_rad = 0;                                ///< largest geodesic angle among the lanes that vouch
    Exclusions excluded_from;                             ///< as in FaultVerdict, of the primary lane
    Stamps stamp_ns{};
    std::uint32_t unit = 0;
    std::uint32_t voter = 0;
    std::uint32_t primary_lane = 0;   ///< lane id
    std::uint32_t vouching_mask = 0;  ///< bit = place of the lane in the system's list
    std::uint32_t excluded_mask = 0;  ///< likewise
    std::uint32_t used_mask = 0;
    std::uint32_t isolated_mask = 0;
    std::uint32_t suspect_mask = 0;
    std::uint32_t reset_counter = 0;
    std::array<std::uint8_t, max_lanes> excluded_why{};  ///< LaneExclusion
    std::uint8_t mode = 0;                               ///< AttitudeMode of the primary
    std::uint8_t level = 0;                              ///< VoteLevel
    std::uint8_t seeded = 0;
    std::uint8_t bridged = 0;
};

}  // namespace quorient
