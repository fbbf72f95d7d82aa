#pragma once

#include "quorient/messages/attitude_state.hpp"
#include "quorient/messages/codes.hpp"
#include "quorient/messages/identity.hpp"
#include "timeline.hpp"

#include <cstdint>
#include <optional>
#include <vector>

namespace quorient::voting {

/// One lane: its latest samples and how it stands.
///
/// Two kinds of exclusion. *Latched* (silent, disagrees, invalid): ends after `return_frames` frames in which the lane agreed with the
/// primary. *For the moment* (initialising, untrusted, uncorroborated, outvoted): seen from the newest sample, ends with its cause.
class LaneTracker {
public:
    LaneTracker() : sample_(frame_window) {}

    /// @returns false for a duplicate.
    bool store(const AttitudeState& sample);

    /// The lane's sample of this frame; null where there is none.
    const AttitudeState* at(Identity identity) const;

    bool has_sample() const { return newest_.has_value(); }
    const AttitudeState& newest() const { return sample_[newest_->sequence % frame_window]; }

    /// The lane can no longer deliver this frame: it delivered it or a later one.
    bool is_past(Identity identity) const { return newest_ && *newest_ >= identity; }

    bool blocked() const { return latched_ != LaneExclusion::none; }
    LaneExclusion latched() const { return latched_; }
    LaneExclusion why() const;

    void latch(LaneExclusion why);
    void release() { latched_ = LaneExclusion::none; }

    /// @returns whether it is another one than before.
    bool label(LaneExclusion momentary);

    /// One frame is judged against the primary.
    /// @returns how many contradicted frames there are in a row.
    unsigned judge(bool agrees, bool contradicted, bool settling);

    unsigned agreeing_frames() const { return agreeing_frames_; }

private:
    std::vector<AttitudeState> sample_;
    std::optional<Identity> newest_;
    LaneExclusion latched_ = LaneExclusion::none;
    LaneExclusion momentary_ = LaneExclusion::none;
    unsigned agreeing_frames_ = 0;
    unsigned contradicted_frames_ = 0;
};

}  // namespace quorient::voting
