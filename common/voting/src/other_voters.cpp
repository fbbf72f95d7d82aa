#include "other_voters.hpp"

#include "quorient/messages/meaning.hpp"
#include "quorient/rotation/quaternion.hpp"

#include <algorithm>
#include <limits>

namespace quorient::voting {

Position position_of(const VotedAttitude& output)
{
    return {identity_of(output), output.output_sequence};
}

void OtherVoter::store(const VotedAttitude& output, std::int64_t now_ns)
{
    received_ns_ = now_ns;
    const Position position = position_of(output);
    if (seen_ && position <= newest_) return;
    seen_ = true;
    newest_ = position;
    output_[output.sequence % frame_window] = output;
}

const VotedAttitude* OtherVoter::at(Identity identity) const
{
    const VotedAttitude& output = output_[identity.sequence % frame_window];
    return output.output_sequence != 0 && identity_of(output) == identity ? &output : nullptr;
}

const VotedAttitude* OtherVoter::before(Identity identity) const
{
    const VotedAttitude* last = nullptr;
    for (const VotedAttitude& output : output_) {
        if (output.output_sequence == 0 || identity_of(output) >= identity) continue;
        if (last == nullptr || identity_of(*last) < identity_of(output)) last = &output;
    }
    return last;
}

std::optional<std::uint32_t> OtherVoter::steady_primary(std::uint64_t frames) const
{
    const VotedAttitude& last = newest();
    for (const VotedAttitude& output : output_) {
        const bool recent = output.output_sequence != 0 && output.epoch == last.epoch && output.sequence + frames > last.sequence;
        if (recent && output.primary_lane != last.primary_lane) return std::nullopt;
    }
    return last.primary_lane;
}

std::uint64_t OtherVoter::number_beside(Identity identity) const
{
    if (newest_.identity.epoch == identity.epoch && newest_.identity <= identity) {
        return newest_.output_sequence + (identity.sequence - newest_.identity.sequence);  // it will have published the frames between
    }
    if (newest_.identity < identity) return newest_.output_sequence + 1;
    if (const VotedAttitude* same = at(identity)) return same->output_sequence;
    const std::uint64_t behind = newest_.identity.epoch == identity.epoch ? newest_.identity.sequence - identity.sequence : 0;
    return newest_.output_sequence - std::min(behind, newest_.output_sequence);
}

std::int64_t OtherVoter::fresh_until_ns(const Durations& durations) const
{
    const AttitudeMode mode = mode_of(newest());
    const bool repeats = mode == AttitudeMode::coasting || mode == AttitudeMode::lost;
    return received_ns_ + durations.lease_ns + (repeats ? durations.coasting_interval_ns : 0);
}

OtherVoters::OtherVoters(const VoterSettings& settings, const Durations& durations) : unit_(settings.unit), durations_(durations)
{
    bool stronger = true;
    for (const std::uint32_t id : settings.voters) {
        if (id == settings.voter) stronger = false;
        else others_.emplace_back(id, stronger);
    }
}

bool OtherVoters::seen() const
{
    return std::any_of(others_.begin(), others_.end(), [](const OtherVoter& other) { return other.seen(); });
}

bool OtherVoters::stronger_seen() const
{
    return std::any_of(others_.begin(), others_.end(), [](const OtherVoter& other) { return other.stronger() && other.seen(); });
}

bool OtherVoters::on_output(const VotedAttitude& output, std::int64_t now_ns)
{
    const auto other = std::find_if(others_.begin(), others_.end(), [&](const OtherVoter& o) { return o.id() == output.voter; });
    if (other == others_.end() || output.unit != unit_) return false;
    if (!rotation::is_attitude(output.attitude) || !rotation::is_attitude(output.reset_rotation)) return false;
    reached_ = std::max(reached_, position_of(output));
    other->store(output, now_ns);
    return true;
}

const OtherVoter* OtherVoters::leader(std::int64_t now_ns) const
{
    for (const OtherVoter& other : others_) {
        if (other.stronger() && other.seen() && now_ns <= other.fresh_until_ns(durations_)) return &other;
    }
    return nullptr;
}

std::int64_t OtherVoters::leader_ends_ns(std::int64_t now_ns) const
{
    const OtherVoter* followed = leader(now_ns);
    return followed == nullptr ? std::numeric_limits<std::int64_t>::max() : followed->fresh_until_ns(durations_) + 1;
}

const OtherVoter* OtherVoters::farthest(std::int64_t now_ns) const
{
    const OtherVoter* farthest = nullptr;
    for (const OtherVoter& other : others_) {
        if (!other.seen() || now_ns > other.fresh_until_ns(durations_)) continue;
        if (farthest == nullptr || farthest->position() < other.position()) farthest = &other;
    }
    return farthest;
}

const VotedAttitude* OtherVoters::at(Identity identity) const
{
    for (const OtherVoter& other : others_) {
        if (const VotedAttitude* output = other.at(identity)) return output;
    }
    return nullptr;
}

const VotedAttitude* OtherVoters::before(Identity identity) const
{
    const VotedAttitude* last = nullptr;
    for (const OtherVoter& other : others_) {
        const VotedAttitude* output = other.before(identity);
        if (output != nullptr && (last == nullptr || identity_of(*last) < identity_of(*output))) last = output;
    }
    return last;
}

bool OtherVoters::are_ahead_of(Identity identity, std::int64_t now_ns) const
{
    const OtherVoter* other = farthest(now_ns);
    return other != nullptr && other->position().identity > identity;
}

Identity OtherVoters::weaker_reached() const
{
    return reached_by(false);
}

Identity OtherVoters::stronger_reached() const
{
    return reached_by(true);
}

Identity OtherVoters::reached_by(bool stronger) const
{
    Identity reached;
    for (const OtherVoter& other : others_) {
        if (other.stronger() == stronger && other.seen()) reached = std::max(reached, other.position().identity);
    }
    return reached;
}

bool OtherVoters::weaker_fresh(std::int64_t now_ns) const
{
    return std::any_of(others_.begin(), others_.end(), [&](const OtherVoter& other) {
        return !other.stronger() && other.seen() && now_ns <= other.fresh_until_ns(durations_);
    });
}

std::uint64_t OtherVoters::next_output_sequence(Identity identity, std::uint64_t own_last) const
{
    if (own_last == 0 && !seen()) return identity.sequence + 1;
    std::uint64_t next = own_last + 1;
    for (const OtherVoter& other : others_) {
        if (other.seen()) next = std::max(next, other.number_beside(identity));
    }
    return next;
}

}  // namespace quorient::voting
