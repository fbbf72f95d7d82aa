#include "listening.hpp"

namespace quorient::voting {
namespace {

/// A voter that has received one of the first frames of an epoch was there before any other had published much.
constexpr std::uint64_t first_frames = 20;

/// By so much the owner goes on before the others.
constexpr std::int64_t owner_first_intervals = 4;

}  // namespace

Listening::Delay Listening::delay(std::int64_t away_ns, std::int64_t mute_ns, std::int64_t promised_ns, Part part, std::int64_t now_ns)
{
    const bool others_exist = part != Part::only_one;
    // The others' last sign of this voter is up to an interval older, and what they publish is on its way for up to another one.
    const std::int64_t replaceable_ns = std::max(durations_.lease_ns / 2, durations_.lease_ns - 2 * durations_.interval_ns);
    const bool late = now_ns > promised_ns + durations_.interval_ns / 2;
    const bool absent = away_ns > durations_.lease_ns || (late && others_exist && mute_ns > replaceable_ns);
    if (!late && !absent) return Delay::none;
    queues_read_ns_ = now_ns + durations_.interval_ns / 2;
    if (!absent && (!others_exist || away_ns <= durations_.lease_ns / 2)) return Delay::none;
    // After an absence the queues are long, and a busy machine takes its time to read them. Where the whole machine stood still, the owner
    // goes on first.
    const std::int64_t after_owner_ns = part == Part::owner ? 0 : std::min(durations_.lease_ns / 2, owner_first_intervals * durations_.interval_ns);
    until_ns_ = std::max(until_ns_, absent && others_exist ? now_ns + durations_.lease_ns + after_owner_ns : queues_read_ns_);
    return absent ? Delay::absence : Delay::pause;
}

Listening::Progress Listening::progress(const std::optional<Identity>& first, const OtherVoters& others, std::int64_t now_ns)
{
    if (now_ns < until_ns_) return Progress::listening;
    const Progress found = begun_ || !others.exist() ? Progress::returned : orientation(first, others, now_ns);
    begun_ = found != Progress::listening;
    return found;
}

Listening::Progress Listening::orientation(const std::optional<Identity>& first, const OtherVoters& others, std::int64_t now_ns)
{
    if (!frames_since_ns_ && first) frames_since_ns_ = now_ns;
    if (first && first->sequence < first_frames) return Progress::begun;
    if (others.seen()) {
        if (!others_since_ns_) others_since_ns_ = now_ns;
        const bool history_read = now_ns >= *others_since_ns_ + durations_.lease_ns;  // a late joiner is sent the other's history first
        return history_read ? Progress::begun : Progress::listening;
    }
    return frames_since_ns_ && now_ns >= *frames_since_ns_ + durations_.listen_ns ? Progress::alone : Progress::listening;
}

}  // namespace quorient::voting
