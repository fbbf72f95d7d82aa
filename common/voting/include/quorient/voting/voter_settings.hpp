#pragma once

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

/// Everything a user can set about voting. Lengths of time in seconds or, where named so, in frames or intervals.
struct VoterSettings {
    std::uint32_t unit = 0;
    std::uint32_t voter = 0;
    std::vector<LaneSettings> lanes;    ///< 1 to max_lanes, ids distinct
    std::vector<std::uint32_t> voters;  ///< ids of all voters of the unit, strongest first; empty = this one alone
    double interval_s = 0;              ///< nominal interval between frames

    double patience = 1.0;        ///< fraction of an interval that a frame waits for votes
    double agreement_rad = 1e-4;  ///< two lanes agree within agreement_rad + agreement_sigmas standard deviations
    double agreement_sigmas = 5;
    unsigned disagreement_frames = 3;  ///< contradicted by a majority in so many frames, a lane is excluded
    unsigned settle_frames = 10;       ///< after a suspicion, until disagreement excludes again
    double silence_intervals = 5;      ///< a lane, or all of them, is silent after so long
    double coasting_to_lost_s = 1;
    double coasting_interval_s = 0.05;  ///< the last attitude is repeated so often while no frames come
    double coasting_rate_rad_s =
        0.02;                      ///< rotation that the last known rate does not tell, for the standard deviation of a coasting attitude
    unsigned return_frames = 200;  ///< agreeing frames until an excluded lane counts again
    double lease_s = 0.05;         ///< of the ownership of `voted`; an own delay above it means: re-synchronise
    double listen_s = 2;           ///< for the other voters, by one that starts in the middle of a stream (their discovery takes its time)
    unsigned level_window = 10;    ///< frames that the level is told from
    unsigned good_frames_before_owning = 20;
};

/// @returns what is wrong with the settings, naming the setting and its value.
tl::expected<void, std::string> check(const VoterSettings& settings);

}  // namespace quorient::voting
