#include "lane_board.hpp"

#include "quorient/messages/left_out.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace quorient::voting {

LaneBoard::LaneBoard(const VoterSettings& settings, std::size_t majority, Corroboration& corroboration, Narrator& narrator)
    : lanes_(settings.lanes.size()),
      majority_(majority),
      return_frames_(settings.return_frames),
      disagreement_frames_(settings.disagreement_frames),
      close_after_(static_cast<std::uint64_t>(std::clamp(std::ceil(settings.silence_intervals), 1.0, remembered / 2.0))),
      agreement_(settings.agreement_rad, settings.agreement_sigmas),
      levels_(settings.lanes.size(), settings.level_window),
      corroboration_(corroboration),
      narrator_(narrator)
{
}

bool LaneBoard::store(LaneIndex index, const AttitudeState& sample)
{
    LaneTracker& lane = lanes_[index];
    if (!lane.store(sample)) return false;
    if (&lane.newest() != lane.at(identity_of(sample))) return true;
    if (!is_countable(sample)) set_label(index, LaneExclusion::initialising, identity_of(sample), 0);
    else if (lane.why() == LaneExclusion::initialising) set_label(index, LaneExclusion::none, identity_of(sample), 0);
    return true;
}

void LaneBoard::reject(LaneIndex index, Identity identity)
{
    if (lanes_[index].latched() != LaneExclusion::invalid) latch(index, LaneExclusion::invalid, identity, 0);
}

void LaneBoard::mark_silent(const Timeline& timeline, std::int64_t silence_ns, std::int64_t now_ns)
{
    for (LaneIndex index = 0; index < lanes_.size(); ++index) {
        if (lanes_[index].blocked()) continue;
        const auto owed = owed_frame(index, timeline);
        if (owed && now_ns - timeline.due_ns(*owed) > silence_ns) latch(index, LaneExclusion::silent, timeline.identity(*owed), 0);
    }
}

std::int64_t LaneBoard::silence_deadline_ns(const Timeline& timeline, std::int64_t silence_ns) const
{
    std::int64_t earliest = std::numeric_limits<std::int64_t>::max();
    for (LaneIndex index = 0; index < lanes_.size(); ++index) {
        if (lanes_[index].blocked()) continue;
        if (const auto owed = owed_frame(index, timeline)) earliest = std::min(earliest, timeline.due_ns(*owed) + silence_ns + 1);
    }
    return earliest;
}

/// The first frame that others delivered and this lane did not, after all that it did.
std::optional<std::uint64_t> LaneBoard::owed_frame(LaneIndex index, const Timeline& timeline) const
{
    const LaneTracker& lane = lanes_[index];
    const bool in_epoch = lane.has_sample() && lane.newest().epoch == timeline.epoch();
    return timeline.next_open(in_epoch ? lane.newest().sequence + 1 : 0);
}

void LaneBoard::release_last_resort(const Timeline& timeline)
{
    if (blocked() != all_axes(lanes_.size())) return;
    for (LaneIndex index = 0; index < lanes_.size(); ++index) {
        LaneTracker& lane = lanes_[index];
        const bool may_return = lane.latched() == LaneExclusion::silent || lane.latched() == LaneExclusion::invalid;
        const bool delivers = lane.has_sample() && lane.is_past(timeline.identity(timeline.next())) && is_countable(lane.newest());
        if (!may_return || !delivers) continue;
        lane.release();
        narrator_.returned(identity_of(lane.newest()), index, "no other lane is left");
    }
}

void LaneBoard::publish(Identity identity, const Ballot& ballot, bool unseeded_remain, std::int64_t now_ns)
{
    ++published_;
    Record& made = record(0);
    made = {identity, ballot, unseeded_remain, true};
    for (LaneIndex a = 0; a < lanes_.size(); ++a) {
        if (!has_lane(ballot.sampled, a)) continue;
        const AttitudeState& sample = *lanes_[a].at(identity);
        if (a == *ballot.primary || &sample == &lanes_[a].newest()) label(a, sample, made, now_ns);
        for (LaneIndex b = a + 1; b < lanes_.size(); ++b) {
            if (has_lane(ballot.sampled, b)) agreement_.remember(a, sample, b, *lanes_[b].at(identity), ballot.sigma_limit);
        }
    }
    levels_.publish(ballot.vouching);
}

void LaneBoard::late_vote(LaneIndex index, const AttitudeState& sample, std::int64_t now_ns)
{
    if (!is_countable(sample)) return;
    const Identity identity = identity_of(sample);
    for (std::uint64_t age = 0; age < std::min<std::uint64_t>(published_, remembered); ++age) {
        Record& made = record(age);
        if (made.identity < identity) return;
        if (made.identity != identity) continue;
        const LaneIndex chosen = *made.ballot.primary;
        const AttitudeState* primary = lanes_[chosen].at(identity);
        if (primary == nullptr) return;
        count_vote(made.ballot, index, sample, *primary, !lanes_[index].blocked(), agreement_);
        agreement_.remember(index, sample, chosen, *primary, made.ballot.sigma_limit);
        if (has_lane(made.ballot.vouching, index)) levels_.late_vote(index, age);
        if (age == 0) label(index, sample, made, now_ns);
        return;
    }
}

void LaneBoard::close(Identity newest)
{
    if (published_ <= close_after_) return;
    Record& made = record(close_after_);
    if (!made.open) return;
    made.open = false;
    const bool backed = is_majority(made.ballot.vouching, made.ballot.seeded, made.unseeded_remain, majority_);
    for (LaneIndex index = 0; index < lanes_.size(); ++index) {
        if (has_lane(made.ballot.sampled, index)) judge(index, made, backed, newest);
    }
}

void LaneBoard::judge(LaneIndex index, const Record& made, bool backed, Identity newest)
{
    LaneTracker& lane = lanes_[index];
    const AttitudeState* sample = lane.at(made.identity);
    const bool agrees = has_lane(made.ballot.agreeing, index);
    const bool comparable = sample != nullptr && left_out_mask(*sample) == made.ballot.left_out;
    const bool settling = corroboration_.settling(made.identity) || corroboration_.settling(newest);
    const unsigned contradicted = lane.judge(agrees, backed && comparable && !agrees, settling);
    if (contradicted >= disagreement_frames_ && lane.latched() != LaneExclusion::disagrees) {
        latch(index, LaneExclusion::disagrees, made.identity, 0);
    }
    if (lane.blocked() && lane.agreeing_frames() >= return_frames_) {
        lane.release();
        narrator_.returned(made.identity, index, "it agreed for long enough");
    }
}

LaneMask LaneBoard::blocked() const
{
    LaneMask mask = 0;
    for (LaneIndex index = 0; index < lanes_.size(); ++index) mask |= lanes_[index].blocked() ? lane_bit(index) : 0;
    return mask;
}

LaneMask LaneBoard::excluded() const
{
    LaneMask mask = 0;
    for (LaneIndex index = 0; index < lanes_.size(); ++index) mask |= lanes_[index].why() != LaneExclusion::none ? lane_bit(index) : 0;
    return mask;
}

bool LaneBoard::unseeded_remain() const
{
    return std::any_of(lanes_.begin(), lanes_.end(), [](const LaneTracker& lane) {
        return lane.has_sample() && !lane.blocked() && lane.newest().seeded == 0 && is_countable(lane.newest());
    });
}

void LaneBoard::latch(LaneIndex index, LaneExclusion why, Identity identity, AxisMask axes)
{
    lanes_[index].latch(why);
    agreement_.forget(index);
    narrator_.excluded(identity, index, why, axes);
}

void LaneBoard::label(LaneIndex index, const AttitudeState& sample, const Record& made, std::int64_t now_ns)
{
    const AttitudeState* primary = lanes_[*made.ballot.primary].at(made.identity);
    const LaneExclusion before = lanes_[index].why();
    const AxisMask apart = (sample.isolated_mask & ~made.ballot.left_out) | (made.ballot.isolated & ~left_out_mask(sample));
    const bool was_apart = before == LaneExclusion::uncorroborated || before == LaneExclusion::outvoted;
    LaneExclusion why = LaneExclusion::none;
    if (primary != nullptr && distrust(sample) > distrust(*primary)) {
        why = LaneExclusion::untrusted;
    } else if (apart != 0 && (was_apart || !corroboration_.settling(made.identity))) {
        const bool alone = (sample.isolated_mask & ~corroboration_.corroborated(now_ns)) != 0;
        why = alone ? LaneExclusion::uncorroborated : LaneExclusion::outvoted;
    }
    set_label(index, why, made.identity, apart);
}

void LaneBoard::set_label(LaneIndex index, LaneExclusion why, Identity identity, AxisMask axes)
{
    LaneTracker& lane = lanes_[index];
    if (!lane.label(why) || lane.blocked()) return;
    if (why != LaneExclusion::none) narrator_.excluded(identity, index, why, axes);
    else narrator_.returned(identity, index, "the cause is gone");
}

}  // namespace quorient::voting
