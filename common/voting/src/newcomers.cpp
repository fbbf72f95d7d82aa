#include "newcomers.hpp"

#include "timeline.hpp"

#include <algorithm>
#include <limits>

namespace quorient::voting {

void Newcomers::hold(std::size_t lane, const AttitudeState& sample, std::int64_t now_ns)
{
    Held& held = held_[lane];
    if (!held.present || !same_timeline(identity_of(held.sample), identity_of(sample))) {
        held.since_ns = now_ns;
        held.first = identity_of(sample);
    }
    held.sample = sample;
    held.present = true;
}

void Newcomers::expected(std::size_t lane, bool counts, std::int64_t now_ns)
{
    held_[lane].present = false;
    if (counts) expected_ns_ = now_ns;
}

std::optional<Identity> Newcomers::accepted(std::int64_t now_ns) const
{
    const bool others_silent = !expected_ns_ || now_ns - *expected_ns_ >= grace_ns_;
    std::optional<Identity> start;
    std::size_t most = 0;
    for (std::size_t lane = 0; lane < lanes_; ++lane) {
        if (!held_[lane].present) continue;
        Identity first = identity_of(held_[lane].sample);
        std::size_t supporters = 0;
        for (std::size_t other = 0; other < lanes_; ++other) {
            if (!held_[other].present || !same_timeline(identity_of(held_[lane].sample), identity_of(held_[other].sample))) continue;
            ++supporters;
            first = std::min(first, identity_of(held_[other].sample));
        }
        const bool waited = others_silent && now_ns - held_[lane].since_ns >= grace_ns_;
        if ((supporters < majority_ && !waited) || supporters <= most) continue;
        most = supporters;
        start = first;
    }
    return start;
}

Identity Newcomers::begin(Identity start) const
{
    Identity begin = start;
    for (std::size_t lane = 0; lane < lanes_; ++lane) {
        const Held& held = held_[lane];
        if (held.present && same_timeline(identity_of(held.sample), start)) begin = std::min(begin, held.first);
    }
    return begin;
}

std::optional<AttitudeState> Newcomers::take(std::size_t lane, Identity start)
{
    Held& held = held_[lane];
    if (!held.present || !same_timeline(identity_of(held.sample), start)) return std::nullopt;
    held.present = false;
    return held.sample;
}

std::int64_t Newcomers::deadline_ns() const
{
    std::int64_t earliest = std::numeric_limits<std::int64_t>::max();
    for (std::size_t lane = 0; lane < lanes_; ++lane) {
        if (held_[lane].present) earliest = std::min(earliest, std::max(held_[lane].since_ns, expected_ns_.value_or(0)) + grace_ns_);
    }
    return earliest;
}

bool Newcomers::same_timeline(const Identity& a, const Identity& b)
{
    const std::uint64_t apart = a.sequence > b.sequence ? a.sequence - b.sequence : b.sequence - a.sequence;
    return a.epoch == b.epoch && apart <= frame_window / 2;
}

}  // namespace quorient::voting
