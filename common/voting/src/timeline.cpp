#include "timeline.hpp"

#include <algorithm>
#include <limits>

namespace quorient::voting {

namespace {

/// Counting ahead of a later one would wrap, and looking for the next frame never end. No publisher gets here in 50 million years.
constexpr std::uint64_t last_sequence = std::numeric_limits<std::uint64_t>::max() / 2;

}  // namespace

void Timeline::start(Identity first, std::int64_t now_ns)
{
    frame_.fill({});
    epoch_ = first.epoch;
    next_ = first.sequence;
    newest_ = first.sequence == 0 ? 0 : first.sequence - 1;
    anchor_sequence_ = first.sequence;
    anchor_ns_ = now_ns;
}

Timeline::Arrival Timeline::classify(Identity identity, std::int64_t now_ns) const
{
    if (identity.sequence > last_sequence) return Arrival::old;
    if (!epoch_ || identity.epoch > *epoch_) return Arrival::ahead;
    if (identity.epoch < *epoch_) return Arrival::old;
    if (identity.sequence < next_) return identity.sequence < oldest() ? Arrival::old : Arrival::late;
    const auto elapsed = static_cast<std::uint64_t>(std::max<std::int64_t>(0, now_ns - anchor_ns_) / interval_ns_);
    const std::uint64_t expected = std::max(anchor_sequence_ + elapsed, next_);
    return identity.sequence > expected + frame_window / 2 ? Arrival::ahead : Arrival::fresh;
}

void Timeline::open(Identity identity, std::int64_t now_ns)
{
    const std::uint64_t sequence = identity.sequence;
    newest_ = std::max(newest_, sequence);
    next_ = std::max(next_, oldest());
    if (sequence < next_) return;
    Frame& frame = frame_[sequence % frame_window];
    if (frame.open && frame.sequence == sequence) return;
    const std::int64_t ahead_frames =
        sequence > anchor_sequence_ ? static_cast<std::int64_t>(std::min(sequence - anchor_sequence_, 2 * frame_window)) : 0;
    const bool long_ago = sequence > anchor_sequence_ + 2 * frame_window;  // only real time can have led so far
    frame = {sequence, long_ago ? now_ns : std::max(now_ns, anchor_ns_ + ahead_frames * interval_ns_), true};
}

void Timeline::publish(std::uint64_t sequence, bool on_votes, std::int64_t now_ns)
{
    const std::int64_t due = due_ns(sequence);
    anchor_sequence_ = sequence;
    anchor_ns_ = on_votes ? std::min(now_ns, due + interval_ns_) : due;  // votes that come in a late burst do not delay what follows
    next_ = sequence + 1;
}

void Timeline::pass(Identity identity)
{
    if (!epoch_ || identity.epoch != *epoch_ || identity.sequence < next_ || identity.sequence > last_sequence) return;
    next_ = identity.sequence + 1;
    newest_ = std::max(newest_, identity.sequence);
}

std::optional<std::uint64_t> Timeline::next_open(std::uint64_t sequence) const
{
    for (std::uint64_t candidate = std::max(sequence, oldest()); candidate <= newest_; ++candidate) {
        const Frame& frame = frame_[candidate % frame_window];
        if (frame.open && frame.sequence == candidate) return candidate;
    }
    return std::nullopt;
}

}  // namespace quorient::voting
