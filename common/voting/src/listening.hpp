#pragma once

#include "durations.hpp"
#include "other_voters.hpp"

#include <cstdint>
#include <optional>

namespace quorient::voting {

/// How long a voter listens before it publishes: at its start until it knows where the stream is, after an absence until its queues are
/// read.
class Listening {
public:
    enum class Progress {
        listening,  ///< Nothing may be published yet.
        begun,      ///< After the start it knows where the stream is.
        alone,      ///< It started in the middle of a stream and no other voter appeared: what is pending may have been published long ago.
        returned,   ///< After a delay its queues are read.
    };

    enum class Delay {
        none,   ///< Nothing to listen for. After a short delay no lane is blamed, and no frame's patience ends, before the queues are read.
        pause,  ///< Another voter may be about to take over: this one listens until its queues are read.
        absence,  ///< Another voter may have taken over: the same, and the right to write `voted` is lost unless nobody did.
    };

    /// What this voter was among the voters before the delay.
    enum class Part {
        only_one,  ///< There are no others.
        owner,     ///< It wrote `voted`.
        standby,   ///< Another one did, or nobody.
    };

    explicit Listening(const Durations& durations) : durations_(durations) {}

    void start(std::int64_t now_ns) { until_ns_ = now_ns + durations_.lease_ns; }

    /// Time went on. @param away_ns      since the last call
    /// @param mute_ns      since this voter's last frame was published, if that is longer: several delays may have followed one another
    /// @param promised_ns  when this voter meant to run again
    Delay delay(std::int64_t away_ns, std::int64_t mute_ns, std::int64_t promised_ns, Part part, std::int64_t now_ns);

    /// Whatever waited in the queues at the last delay has been handed in by then.
    std::int64_t queues_read_ns() const { return queues_read_ns_; }

    /// To be asked while listening. @param first  first frame received of the present timeline; none before it
    Progress progress(const std::optional<Identity>& first, const OtherVoters& others, std::int64_t now_ns);

    /// Frames that came before that have been published by whoever runs.
    std::int64_t unanswered_ns() const { return durations_.lease_ns / 2; }

    /// A voter runs at least twice in a lease, so that it notices its own delays.
    std::int64_t look_again_ns(std::int64_t now_ns) const { return now_ns + std::max<std::int64_t>(1, durations_.lease_ns / 2); }

    /// Calls `consider` with the times at which progress() changes by itself.
    template <class Consider>
    void consider_deadlines(Consider consider) const
    {
        consider(queues_read_ns_);
        consider(until_ns_);
        if (frames_since_ns_) consider(*frames_since_ns_ + durations_.listen_ns);
        if (others_since_ns_) consider(*others_since_ns_ + durations_.lease_ns);
    }

private:
    Progress orientation(const std::optional<Identity>& first, const OtherVoters& others, std::int64_t now_ns);

    Durations durations_;                          ///< Interval, lease and listen_s are used.
    std::int64_t until_ns_ = 0;                    ///< Listening lasts until then at least.
    std::int64_t queues_read_ns_ = 0;              ///< Half an interval after the last delay.
    bool begun_ = false;                           ///< Listening has ended once, so that only a delay can be its cause.
    std::optional<std::int64_t> frames_since_ns_;  ///< When the first frame was there.
    std::optional<std::int64_t> others_since_ns_;  ///< When another voter's output was there first.
};

}  // namespace quorient::voting
