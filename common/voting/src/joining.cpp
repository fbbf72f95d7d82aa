#include "joining.hpp"

#include "quorient/messages/time.hpp"

#include <utility>

namespace quorient::voting {
namespace {

/// A voter that has seen one of the first frames of an epoch was there before any other had published much.
constexpr std::uint64_t first_frames = 20;

}  // namespace

Joining::Joining(const VoterSettings& settings, bool has_others)
    : interval_ns_(std::max<std::int64_t>(1, nanoseconds(settings.interval_s))),
      lease_ns_(nanoseconds(settings.lease_s)),
      listen_ns_(nanoseconds(settings.listen_s)),
      has_others_(has_others)
{
}

void Joining::begin(std::int64_t now_ns)
{
    if (has_others_) until_ns_ = now_ns + lease_ns_;
}

void Joining::was_delayed(std::int64_t now_ns, std::int64_t away_ns)
{
    drained_ns_ = now_ns + interval_ns_ / 2;
    if (away_ns <= lease_ns_ / 2 || !has_others_) return;
    until_ns_ = std::max(until_ns_.value_or(0), drained_ns_);  // another voter may just have taken over
}

void Joining::start_over(std::int64_t now_ns)
{
    drained_ns_ = now_ns + interval_ns_ / 2;
    discards_ = true;
    until_ns_ = has_others_ ? now_ns + lease_ns_ : drained_ns_;
}

bool Joining::is_over(std::int64_t now_ns, const Timeline& timeline, const VoterRanking& ranking)
{
    return until_ns_ && now_ns >= *until_ns_ && knows_where_to_begin(now_ns, timeline, ranking);
}

bool Joining::knows_where_to_begin(std::int64_t now_ns, const Timeline& timeline, const VoterRanking& ranking)
{
    if (!starts_ || !has_others_) return true;
    if (!frames_since_ns_ && timeline.started()) {
        frames_since_ns_ = now_ns;
        from_the_beginning_ = timeline.newest().sequence < first_frames;
    }
    if (from_the_beginning_) return true;
    if (ranking.has_heard()) {
        if (!heard_since_ns_) heard_since_ns_ = now_ns;
        return now_ns >= *heard_since_ns_ + lease_ns_;  // what it hears first is the other's history
    }
    discards_ = frames_since_ns_ && now_ns >= *frames_since_ns_ + listen_ns_;
    return discards_;
}

bool Joining::finish()
{
    until_ns_.reset();
    starts_ = false;
    return std::exchange(discards_, false);
}

}  // namespace quorient::voting
