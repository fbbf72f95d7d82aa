#pragma once

#include "agreement.hpp"
#include "quorient/messages/attitude_state.hpp"
#include "quorient/messages/limits.hpp"

#include <array>
#include <cstddef>
#include <optional>

namespace quorient::voting {

using LaneIndex = std::size_t;  ///< place in the system's list of lanes

/// A lane's sample may stand in a ballot: it fuses something and is past its start.
bool is_countable(const AttitudeState& sample);

/// 0: the lane trusts itself; 1 UNTRUSTED; 2 LOST. A lane that trusts itself more puts the others aside.
int distrust(const AttitudeState& sample);

/// Seeded lanes only repeat what was voted: they make no majority among themselves while a lane that knows better remains.
bool is_majority(LaneMask lanes, LaneMask seeded, bool unseeded_remain, std::size_t majority);

constexpr LaneMask lane_bit(LaneIndex lane)
{
    return LaneMask{1} << lane;
}
constexpr bool has_lane(LaneMask mask, LaneIndex lane)
{
    return (mask & lane_bit(lane)) != 0;
}

/// What is known about one frame.
struct BallotPaper {
    std::array<const AttitudeState*, max_lanes> sample{};  ///< countable samples of this frame; null where there is none
    LaneMask blocked = 0;                                  ///< excluded lanes: they are compared and never chosen
    AxisMask corroborated = 0;                             ///< axes that a majority of detectors reports
    std::size_t lanes = 0;
    std::size_t majority = 1;  ///< so many of the configured lanes
    bool unseeded_remain = true;
    bool settling = false;
    LaneIndex wanted = 0;   ///< the primary that the stronger voter chose, or the one that is
    LaneIndex current = 0;  ///< the primary that is
};

/// What follows for this frame.
struct Ballot {
    std::optional<LaneIndex> primary;  ///< none: no lane can be chosen
    bool backed = false;               ///< a majority vouches for it
    bool several_groups = false;       ///< the lanes have isolated different axes
    AxisMask isolated = 0;             ///< by the winning group
    AxisMask left_out = 0;             ///< by the primary: isolated, and left out provisionally
    LaneMask sampled = 0;              ///< lanes with a countable sample
    LaneMask agreeing = 0;             ///< all of these that agree with the primary
    LaneMask vouching = 0;             ///< all of these that are not excluded
    LaneMask seeded = 0;               ///< lanes with a countable sample that took over a voted attitude
    double sigma_limit = 0;
    double spread_rad = 0;  ///< largest angle between two lanes that vouch
};

/// Counts one lane's vote on the primary's sample of the same frame: each lane's before the frame is published, and those that come late.
/// @param may_vouch  false for an excluded lane, which is compared only.
void count_vote(Ballot& ballot, LaneIndex lane, const AttitudeState& sample, const AttitudeState& primary, bool may_vouch,
                const Agreement& agreement);

/// Chooses the group (lanes that isolate the same axes), then the primary within it.
///
/// Group: the one that lacks the fewest corroborated axes, then the one with the fewest uncorroborated ones; so an isolation that
/// only its own detector sees cannot move the output, and one that a majority sees does so although most lanes are still late.
/// Primary: the wanted lane, unless a majority of the group agrees with one another and not with it. While the dust of a corroborated
/// isolation settles, the wanted lane stays even then: the majority may simply be late.
///
/// Lanes may differ in the axes that they leave out provisionally, and one may isolate what another leaves out so: they stay in one group
/// and vouch for each other while their attitudes agree. While a suspicion settles, lanes that use an axis do not contradict one that
/// leaves it out if a majority reports that axis.
Ballot count(const BallotPaper& paper, const Agreement& agreement);

}  // namespace quorient::voting
