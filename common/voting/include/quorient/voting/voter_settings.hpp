#pragma once

#include "quorient/settings/setting.hpp"

#include <cstdint>
#include <string>
#include <tl/expected.hpp>
#include <vector>

namespace quorient::voting {

/// One lane as the voter knows it; its place in the list is its bit in every LaneMask.
struct LaneSettings {
    std::uint32_t lane = 0;
    std::uint32_t detector = 0;  ///< whose verdicts belong to the lane
    std::string name;
};

/// Everything that a voter must know. What of it a user can set, and what that means, stands in voter_record().
struct VoterSettings {
    std::uint32_t unit = 0;
    std::uint32_t voter = 0;
    std::vector<LaneSettings> lanes;    ///< 1 to max_lanes, ids distinct
    std::vector<std::uint32_t> voters;  ///< ids of all voters of the unit, strongest first; empty = this one alone
    double interval_s = 0;              ///< nominal interval between frames

    double patience = 1.0;
    double agreement_rad = 1e-4;
    double agreement_sigmas = 5;
    unsigned disagreement_frames = 3;
    unsigned settle_frames = 10;
    double silence_intervals = 5;
    double coasting_to_lost_s = 1;
    double coasting_interval_s = 0.05;
    double coasting_rate_rad_s = 0.02;
    unsigned return_frames = 200;
    double lease_s = 0.05;
    double listen_s = 2;
    unsigned level_window = 10;
    unsigned good_frames_before_owning = 20;
};

/// The settings of a system file's section `voting`.
settings::Record<VoterSettings> voter_record();

/// @returns what is wrong with the settings, naming the setting and its value.
tl::expected<void, std::string> check(const VoterSettings& settings);

}  // namespace quorient::voting
