#pragma once

#include "quorient/messages/exclusions.hpp"
#include "quorient/messages/limits.hpp"
#include "quorient/messages/stamps.hpp"

#include <array>
#include <cstdint>

namespace quorient {

/// One lane's attitude at the end of one frame.
struct AttitudeState {
    std::uint64_t epoch = 0;
    std::uint64_t sequence = 0;
    std::int64_t sample_time_ns = 0;
    std::uint64_t verdict_epoch = 0;  ///< identity of the newest verdict applied
    std::uint64_t verdict_sequence = 0;
    std::array<double, 4> attitude{1, 0, 0, 0};           ///< q_RB, body -> reference, Hamilton (w,x,y,z)
    std::array<double, 4> reset_rotation{1, 0, 0, 0};     ///< q_new o conj(q_old) of the latest reset
    std::array<double, 3> rate_rad_s{};                   ///< body frame, mean over the frame's interval
    double angle_sigma_rad = 0;                           ///< standard deviation of the attitude's angle error
    Exclusions excluded_from;                             ///< as in FaultVerdict: what a restarted detector or integrator adopts
    Stamps stamp_ns{};
    std::uint32_t unit = 0;
    std::uint32_t lane = 0;
    std::uint32_t used_mask = 0;
    std::uint32_t isolated_mask = 0;
    std::uint32_t suspect_mask = 0;
    std::uint32_t rolled_back_frames = 0;  ///< re-integrated for this sample
    std::uint32_t reset_counter = 0;
    std::uint8_t mode = 0;     ///< AttitudeMode
    std::uint8_t seeded = 0;   ///< started from the voted attitude
    std::uint8_t bridged = 0;  ///< this interval spans frames that never arrived
    std::uint8_t padding = 0;
};

}  // namespace quorient
