#include "quorient/voting/voter_ranking.hpp"

#include "quorient/messages/codes.hpp"
#include "quorient/messages/meaning.hpp"
#include "quorient/voting/agreement.hpp"
#include "quorient/messages/time.hpp"

#include <algorithm>
#include <limits>

namespace quorient::voting {
namespace {

/// So long a voter that starts waits to catch up with the others before it writes nevertheless.
constexpr unsigned longest_lag_frames = 400;

bool is_repeated(const VotedAttitude& output)
{
    return mode_of(output) == AttitudeMode::coasting || mode_of(output) == AttitudeMode::lost;
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
      good_frames_required_(settings.good_frames_before_owning),
      listen_frames_(static_cast<unsigned>(settings.listen_s / settings.interval_s))
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

bool VoterRanking::has_heard() const
{
    return std::any_of(others_.begin(), others_.end(), [](const Other& other) { return other.heard; });
}

bool VoterRanking::has_heard_stronger() const
{
    return std::any_of(others_.begin(), others_.end(), [](const Other& other) { return other.stronger && other.heard; });
}

bool VoterRanking::established() const
{
    const bool has_looked_up = !has_stronger() || has_heard_stronger() || listened_ >= listen_frames_;
    return has_looked_up && good_frames_ >= good_frames_required_;
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
    if (own_sequence_ == 0 && !has_heard()) return identity.sequence + 1;
    std::uint64_t next = own_sequence_ + 1;
    for (const Other& other : others_) {
        if (other.heard) next = std::max(next, number_beside(other, identity));
    }
    return next;
}

/// The number that keeps in step with this voter: its own number of this frame, or the one after that of the frame before.
std::uint64_t VoterRanking::number_beside(const Other& other, Identity identity)
{
    const Position& newest = other.newest;
    if (newest.identity <= identity) return newest.output_sequence + (newest.identity == identity ? 0 : 1);
    const VotedAttitude& same = other.output[identity.sequence % remembered];
    if (identity_of(same) == identity) return same.output_sequence;
    const std::uint64_t behind = newest.identity.epoch == identity.epoch ? newest.identity.sequence - identity.sequence : 0;
    return newest.output_sequence - std::min(behind, newest.output_sequence);
}

bool VoterRanking::may_write(Position position, bool repeated)
{
    if (!established()) {
        if (!repeated) {
            ++good_frames_;
            ++listened_;
        }
        written_ = std::max(written_, highest_seen_);
        return false;
    }
    if (!writing_ && must_hold_back(position)) {
        ++held_back_;
        written_ = std::max(written_, highest_seen_);
        return false;
    }
    writing_ = true;
    const bool forward =
        repeated ? position > written_ && position.identity >= highest_seen_.identity : position.identity > written_.identity;
    if (forward) written_ = position;
    return forward;
}

/// A weaker voter has written this frame already: the first frame of a new owner would be a step back for its readers. One that is merely
/// quicker must not keep the owner away for good; to one that lags behind, the owner has to catch up first.
bool VoterRanking::must_hold_back(Position position) const
{
    for (const Other& other : others_) {
        const Identity theirs = other.newest.identity;
        if (other.stronger || !other.heard || position.identity > theirs) continue;
        const bool lags = theirs.epoch > position.identity.epoch || theirs.sequence > position.identity.sequence + 1;
        if (held_back_ < (lags ? longest_lag_frames : good_frames_required_)) return true;
    }
    return false;
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
