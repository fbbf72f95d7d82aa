#include "quorient/voting/voter_ranking.hpp"

#include "quorient/messages/codes.hpp"
#include "quorient/voting/agreement.hpp"
#include "quorient/voting/nanoseconds.hpp"

#include <algorithm>
#include <limits>

namespace quorient::voting {
namespace {

bool is_repeated(const VotedAttitude& output)
{
    return output.mode == static_cast<std::uint8_t>(AttitudeMode::coasting) || output.mode == static_cast<std::uint8_t>(AttitudeMode::lost);
}

Position position_of(const VotedAttitude& output)
{
    return {identity_of(output), output.output_sequence};
}

}  // namespace

VoterRanking::VoterRanking(const VoterSettings& settings)
    : unit_(settings.unit),
      lease_ns_(nanoseconds(settings.lease_s)),
      coasting_interval_ns_(nanoseconds(settings.coasting_interval_s)),
      good_frames_required_(settings.good_frames_before_owning)
{
    bool stronger = true;
    for (const std::uint32_t voter : settings.voters) {
        if (voter == settings.voter) {
            stronger = false;
            continue;
        }
        others_.emplace_back();
        others_.back().voter = voter;
        others_.back().stronger = stronger;
    }
}

bool VoterRanking::on_output(const VotedAttitude& output, std::int64_t now_ns)
{
    const auto other = std::find_if(others_.begin(), others_.end(), [&](const Other& o) { return o.voter == output.voter; });
    if (other == others_.end() || output.unit != unit_ || !is_attitude(output.attitude) || !is_attitude(output.reset_rotation))
        return false;
    other->heard_ns = now_ns;
    const Position position = position_of(output);
    highest_seen_ = std::max(highest_seen_, position);
    if (other->heard && position <= other->newest) return true;
    other->heard = true;
    other->newest = position;
    other->output[output.sequence % remembered] = output;
    return true;
}

const VotedAttitude* VoterRanking::leader(std::int64_t now_ns) const
{
    const Other* other = leading(now_ns);
    return other == nullptr ? nullptr : &newest(*other);
}

const VotedAttitude* VoterRanking::leader_at(Identity identity, std::int64_t now_ns) const
{
    const Other* other = leading(now_ns);
    if (other == nullptr) return nullptr;
    const VotedAttitude& output = other->output[identity.sequence % remembered];
    return identity_of(output) == identity ? &output : nullptr;
}

const VotedAttitude* VoterRanking::leader_before(Identity identity, std::int64_t now_ns) const
{
    const Other* other = leading(now_ns);
    if (other == nullptr) return nullptr;
    const VotedAttitude* last = nullptr;
    for (const VotedAttitude& output : other->output) {
        if (output.output_sequence == 0 || identity_of(output) >= identity) continue;
        if (last == nullptr || identity_of(*last) < identity_of(output)) last = &output;
    }
    return last;
}

std::optional<std::uint32_t> VoterRanking::leaders_primary(std::uint64_t frames, std::int64_t now_ns) const
{
    const Other* other = leading(now_ns);
    if (other == nullptr) return std::nullopt;
    const VotedAttitude& last = newest(*other);
    for (const VotedAttitude& output : other->output) {
        const bool recent = output.output_sequence != 0 && output.epoch == last.epoch && output.sequence + frames > last.sequence;
        if (recent && output.primary_lane != last.primary_lane) return std::nullopt;
    }
    return last.primary_lane;
}

const VotedAttitude* VoterRanking::farthest(std::int64_t now_ns) const
{
    const Other* farthest = nullptr;
    for (const Other& other : others_) {
        if (!other.heard || now_ns > fresh_until_ns(other)) continue;
        if (farthest == nullptr || farthest->newest < other.newest) farthest = &other;
    }
    return farthest == nullptr ? nullptr : &newest(*farthest);
}

std::uint64_t VoterRanking::next_output_sequence(Identity identity) const
{
    std::uint64_t next = own_sequence_ + 1;
    for (const Other& other : others_) {
        if (!other.heard || other.newest.identity > identity) continue;
        next = std::max(next, other.newest.output_sequence + (other.newest.identity == identity ? 0 : 1));
    }
    return next;
}

bool VoterRanking::may_write(Position position, bool repeated)
{
    own_sequence_ = position.output_sequence;
    if (!established()) {
        if (!repeated) ++good_frames_;
        written_ = std::max(written_, highest_seen_);
        return false;
    }
    if (!writing_ && is_overtaken(position) && held_back_ < good_frames_required_) {
        ++held_back_;
        written_ = std::max(written_, highest_seen_);
        return false;
    }
    writing_ = true;
    for (const Other& other : others_) {
        if (other.stronger && other.heard) written_ = std::max(written_, other.newest);
    }
    const bool forward =
        repeated ? position > written_ && position.identity >= highest_seen_.identity : position.identity > written_.identity;
    if (forward) written_ = position;
    return forward;
}

/// A weaker voter has written this frame already: the first frame of a new owner would be a step back for its readers.
bool VoterRanking::is_overtaken(Position position) const
{
    return std::any_of(others_.begin(), others_.end(),
                       [&](const Other& other) { return !other.stronger && other.heard && position.identity <= other.newest.identity; });
}

bool VoterRanking::is_behind(Identity identity, std::int64_t now_ns) const
{
    const VotedAttitude* other = farthest(now_ns);
    return other != nullptr && identity_of(*other) > identity;
}

void VoterRanking::start_over()
{
    good_frames_ = held_back_ = 0;
    writing_ = false;
}

std::int64_t VoterRanking::leader_ends_ns(std::int64_t now_ns) const
{
    const Other* other = leading(now_ns);
    return other == nullptr ? std::numeric_limits<std::int64_t>::max() : fresh_until_ns(*other) + 1;
}

const VoterRanking::Other* VoterRanking::leading(std::int64_t now_ns) const
{
    for (const Other& other : others_) {
        if (other.stronger && other.heard && now_ns <= fresh_until_ns(other)) return &other;
    }
    return nullptr;
}

std::int64_t VoterRanking::fresh_until_ns(const Other& other) const
{
    return other.heard_ns + lease_ns_ + (is_repeated(newest(other)) ? coasting_interval_ns_ : 0);
}

}  // namespace quorient::voting
