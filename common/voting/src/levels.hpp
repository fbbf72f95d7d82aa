#pragma once

#include "quorient/messages/codes.hpp"
#include "quorient/messages/limits.hpp"

#include <array>
#include <cstddef>
#include <cstdint>

namespace quorient::voting {

/// How many lanes stand behind the output, counted over the last `window` frames before the newest one: votes of the newest
/// may still be on their way.
///
/// A lane stands behind the output once it vouched for 8 of 10 frames, and no longer when it vouched for half of them or fewer.
class Levels {
public:
    Levels(std::size_t lanes, unsigned window) : lanes_(lanes), window_(window) {}

    /// A frame was published; these lanes vouch for it.
    void publish(LaneMask vouching);

    /// A vote for the frame published `age` frames before the newest one.
    void late_vote(std::size_t lane, std::uint64_t age);

    /// What was before says nothing any more.
    void clear();

    LaneMask standing() const { return standing_; }

    /// @param excluded lanes that do not count now; @param redundancy_left false: the detectors could name no further fault.
    VoteLevel level(LaneMask excluded, bool redundancy_left) const;

private:
    void count_standing();

    std::array<std::uint64_t, max_lanes> votes_{};  ///< bit 0 = the newest frame
    std::size_t lanes_;
    unsigned window_;
    unsigned frames_ = 0;  ///< at most window_ + 1
    LaneMask standing_ = 0;
};

}  // namespace quorient::voting
