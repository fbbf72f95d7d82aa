#include "owned_stream.hpp"

#include <algorithm>
#include <limits>

namespace quorient::voting {
namespace {

/// A voter that starts waits so long to catch up with the others before it writes nevertheless.
constexpr unsigned longest_lag_frames = 400;

}  // namespace

OwnedStream::OwnedStream(const VoterSettings& settings, const Durations& durations)
    : interval_ns_(durations.interval_ns),
      lease_ns_(durations.lease_ns),
      good_frames_required_(settings.good_frames_before_owning),
      lag_frames_(static_cast<std::uint64_t>(durations.lease_ns / 2 / durations.interval_ns)),
      listen_frames_(static_cast<unsigned>(settings.listen_s / settings.interval_s)),
      not_before_ns_(std::numeric_limits<std::int64_t>::min()),
      punctuality_(durations.interval_ns)
{
}

void OwnedStream::push(const VotedAttitude& output, bool repeated, std::int64_t now_ns)
{
    waiting_.push() = {output, now_ns + interval_ns_, repeated};
    if (!repeated) punctuality_.see(identity_of(output), now_ns);
}

void OwnedStream::release(const OtherVoters& others, std::int64_t now_ns)
{
    const OtherVoter* leader = others.leader(now_ns);
    consider_right(others, now_ns);
    for (const Waiting* first = waiting_.front(); first != nullptr; first = waiting_.front()) {
        const bool leader_was_here = leader == nullptr || leader->position().identity >= identity_of(first->output);
        if (!leader_was_here && now_ns < first->due_ns) return;
        if (may_write(*first, others, now_ns)) ready_.push() = first->output;
        waiting_.drop_front();
        consider_right(others, now_ns);
    }
}

void OwnedStream::start_over(std::int64_t now_ns)
{
    right_ = Right::proving;
    good_frames_ = held_ = 0;
    // After one lease this voter gives out at once what nobody else has: the others need time to find it there again before it writes.
    not_before_ns_ = now_ns + lease_ns_ + good_frames_required_ * interval_ns_;
}

void OwnedStream::resume(const OtherVoters& others)
{
    if (right_ != Right::proving) return;
    right_ = Right::writing;
    good_frames_ = good_frames_required_;
    // A voter that went on for an interval longer has ceased to wait for this one, and written what this one had decided to.
    if (others.reached().identity > written_.identity) ready_.clear();
    written_ = std::max(written_, others.reached());
}

std::int64_t OwnedStream::deadline_ns() const
{
    const Waiting* first = waiting_.front();
    return first == nullptr ? std::numeric_limits<std::int64_t>::max() : first->due_ns;
}

void OwnedStream::consider_right(const OtherVoters& others, std::int64_t now_ns)
{
    const bool discovered = !others.stronger_exist() || others.stronger_seen() || listened_ >= listen_frames_;
    const bool proven = discovered && good_frames_ >= good_frames_required_ && now_ns >= not_before_ns_;
    if (right_ != Right::proving || !proven) return;
    right_ = Right::holding;
    ready_.clear();
}

/// Asked once for every output, in order.
bool OwnedStream::may_write(const Waiting& waiting, const OtherVoters& others, std::int64_t now_ns)
{
    const Position position = position_of(waiting.output);
    if (right_ == Right::holding && !must_hold(position.identity, others, now_ns)) right_ = Right::writing;
    if (right_ != Right::writing) {
        held_ += right_ == Right::holding ? 1 : 0;
        good_frames_ += waiting.repeated ? 0 : 1;
        listened_ += waiting.repeated ? 0 : 1;
        written_ = std::max(written_, others.reached());
        return false;
    }
    if (passes_over(position.identity, others)) return false;
    const bool forward =
        waiting.repeated ? position > written_ && position.identity >= others.reached().identity : position.identity > written_.identity;
    if (forward) written_ = position;
    return forward;
}

/// A stronger voter has written this frame long ago. Should that one have ended since, readers would see a step back.
bool OwnedStream::passes_over(Identity identity, const OtherVoters& others)
{
    const Identity theirs = others.stronger_reached();
    const bool far = identity.epoch == theirs.epoch && identity.sequence + lag_frames_ < theirs.sequence;
    const bool catches_up = behind_ || far;
    behind_ = catches_up && identity < theirs;
    return catches_up && identity <= theirs;
}

/// A weaker voter has published this frame: the first frame of a new owner would be a step back for readers. A weaker voter that is merely
/// quicker must not keep the owner away for good; with one that is farther by frames, the owner has to catch up first. Where a frame is
/// late here, a weaker voter may have ceased to wait for it, and what it has published is still on its way.
bool OwnedStream::must_hold(Identity identity, const OtherVoters& others, std::int64_t now_ns) const
{
    const Identity theirs = others.weaker_reached();
    if (identity > theirs) {
        const bool late = punctuality_.lateness_ns(identity, now_ns) > interval_ns_ / 2;
        return late && others.weaker_fresh(now_ns) && held_ < longest_lag_frames;
    }
    const bool lags = theirs.epoch > identity.epoch || theirs.sequence > identity.sequence + 1;
    return held_ < (lags ? longest_lag_frames : good_frames_required_);
}

}  // namespace quorient::voting
