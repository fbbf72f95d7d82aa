#include "lane_tracker.hpp"

namespace quorient::voting {

bool LaneTracker::store(const AttitudeState& sample)
{
    const Identity identity = identity_of(sample);
    AttitudeState& place = sample_[identity.sequence % frame_window];
    if (newest_ && identity_of(place) >= identity) return false;
    place = sample;
    if (!newest_ || identity > *newest_) newest_ = identity;
    return true;
}

const AttitudeState* LaneTracker::at(Identity identity) const
{
    const AttitudeState& place = sample_[identity.sequence % frame_window];
    return newest_ && identity_of(place) == identity ? &place : nullptr;
}

LaneExclusion LaneTracker::why() const
{
    if (latched_ == LaneExclusion::none || momentary_ == LaneExclusion::initialising) return momentary_;
    return latched_;
}

void LaneTracker::latch(LaneExclusion why)
{
    latched_ = why;
    agreeing_frames_ = 0;
    contradicted_frames_ = 0;
}

bool LaneTracker::label(LaneExclusion momentary)
{
    const bool changed = momentary != momentary_;
    momentary_ = momentary;
    return changed;
}

unsigned LaneTracker::judge(bool agrees, bool contradicted, bool settling)
{
    if (agrees) {
        ++agreeing_frames_;
        contradicted_frames_ = 0;
    } else if (!settling) {
        agreeing_frames_ = 0;
        if (contradicted) ++contradicted_frames_;
    }
    return contradicted_frames_;
}

}  // namespace quorient::voting
