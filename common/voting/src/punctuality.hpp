#pragma once

#include "quorient/messages/identity.hpp"

#include <algorithm>
#include <cstdint>

namespace quorient::voting {

/// How much later than the most punctual one of the recent frames a frame is. Frames come at equal intervals, so that the time of each but
/// for its number of intervals is the same, plus its delay.
class Punctuality {
public:
    explicit Punctuality(std::int64_t interval_ns) : interval_ns_(interval_ns) {}

    /// A frame is there.
    void see(Identity identity, std::int64_t now_ns)
    {
        if (identity.epoch != epoch_) *this = Punctuality(interval_ns_);
        epoch_ = identity.epoch;
        // The memory fades, as a publisher's interval is not exactly the stated one.
        earliest_ns_ = seen_ ? std::min(earliest_ns_ + interval_ns_ / fading_frames, start_ns(identity, now_ns)) : start_ns(identity, now_ns);
        seen_ = true;
    }

    /// How late it would be to act on a frame now.
    std::int64_t lateness_ns(Identity identity, std::int64_t now_ns) const
    {
        return seen_ && identity.epoch == epoch_ ? start_ns(identity, now_ns) - earliest_ns_ : 0;
    }

private:
    /// In so many frames a delay of one interval is forgotten.
    static constexpr std::int64_t fading_frames = 64;

    /// When the epoch would have begun, had this frame not been delayed.
    std::int64_t start_ns(Identity identity, std::int64_t now_ns) const
    {
        return now_ns - static_cast<std::int64_t>(identity.sequence) * interval_ns_;
    }

    std::int64_t interval_ns_;       ///< Between frames.
    std::uint64_t epoch_ = 0;        ///< The epoch of the frames that were seen.
    bool seen_ = false;              ///< A frame of the epoch was seen; earliest_ns_ means nothing before.
    std::int64_t earliest_ns_ = 0;   ///< start_ns() of the most punctual frame.
};

}  // namespace quorient::voting
