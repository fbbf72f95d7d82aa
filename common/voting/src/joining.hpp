#pragma once

#include "quorient/voting/timeline.hpp"
#include "quorient/voting/voter_ranking.hpp"
#include "quorient/voting/voter_settings.hpp"

#include <algorithm>
#include <cstdint>
#include <optional>

namespace quorient::voting {

/// When a voter may speak: not before it knows where the stream is. One that starts, or was away longer than its lease, listens to the
/// others first; one that was delayed shortly lets its queues be emptied before it blames a lane for what lay in them.
class Joining {
public:
    /// @param has_others  there are other voters to listen to
    Joining(const VoterSettings& settings, bool has_others);

    void begin(std::int64_t now_ns);

    /// After so long without an output, be it in one absence or in several that followed one another, another voter may have taken over
    /// or do so before it could be heard: the last sign of life is up to an interval older, and what the other says is on its way for up
    /// to another one.
    bool may_be_replaced(std::int64_t mute_ns) const
    {
        return has_others_ && mute_ns > std::max(lease_ns_ / 2, lease_ns_ - 2 * interval_ns_);
    }

    /// This voter did not look for so long, less than its lease, and later than it had meant to.
    void was_delayed(std::int64_t now_ns, std::int64_t away_ns);

    /// It was away about its lease or longer: perhaps no longer believed by anyone. What is pending is too old to publish.
    void start_over(std::int64_t now_ns);

    /// Nothing is published yet.
    bool listens() const { return until_ns_.has_value(); }

    /// After a short delay: what waited in the queues has been handed in.
    std::int64_t drained_ns() const { return drained_ns_; }

    /// It has listened long enough. In the middle of a stream there is another voter to be expected, whose numbers and primary are to be
    /// taken over.
    bool is_over(std::int64_t now_ns, const Timeline& timeline, const VoterRanking& ranking);

    /// @returns whether what is pending is too old to publish.
    bool finish();

    /// Tells `consider` the times at which something changes here by itself.
    template <class Consider>
    void tell_deadlines(Consider consider) const
    {
        consider(drained_ns_);
        if (!until_ns_) return;
        consider(*until_ns_);
        if (frames_since_ns_) consider(*frames_since_ns_ + listen_ns_);
        if (heard_since_ns_) consider(*heard_since_ns_ + lease_ns_);
    }

private:
    bool knows_where_to_begin(std::int64_t now_ns, const Timeline& timeline, const VoterRanking& ranking);

    std::int64_t interval_ns_;
    std::int64_t lease_ns_;
    std::int64_t listen_ns_;
    bool has_others_;

    std::optional<std::int64_t> until_ns_;
    std::int64_t drained_ns_ = 0;
    bool starts_ = true;                           ///< has not published since the process began
    std::optional<std::int64_t> frames_since_ns_;  ///< when the first frame came
    std::optional<std::int64_t> heard_since_ns_;   ///< when another voter was heard first
    bool from_the_beginning_ = false;              ///< the first frame was among the first of its epoch
    bool discards_ = false;
};

}  // namespace quorient::voting
