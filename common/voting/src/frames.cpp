#include "frames.hpp"

#include "quorient/messages/left_out.hpp"
#include "quorient/messages/restart.hpp"
#include "quorient/messages/time.hpp"

#include <algorithm>

namespace quorient::voting {

Frames::Frames(const VoterSettings& settings, const Durations& durations, Narrator& narrator, VoterCounters& counters)
    : settings_(settings),
      durations_(durations),
      majority_(settings.lanes.size() / 2 + 1),
      timeline_(durations.interval_ns),
      newcomers_(settings.lanes.size(), majority_, std::max(durations.silence_ns, nanoseconds(least_restart_silence_s))),
      corroboration_(settings.lanes.size(), majority_, settings.settle_frames, settings.return_frames, durations.silence_ns),
      board_(settings, majority_, corroboration_, narrator),
      narrator_(narrator),
      counters_(counters)
{
}

void Frames::on_attitude(const AttitudeState& attitude, std::int64_t now_ns)
{
    const auto lane = lane_of(attitude.lane);
    if (!lane || attitude.unit != settings_.unit) {
        ++counters_.foreign;
    } else if (++counters_.received; is_sound(attitude)) {
        receive(*lane, attitude, now_ns);
    } else {
        ++counters_.rejected;
        board_.reject(*lane, identity_of(attitude));
    }
}

void Frames::on_verdict(const FaultVerdict& verdict, std::int64_t now_ns)
{
    const auto same = std::find_if(settings_.lanes.begin(), settings_.lanes.end(),
                                   [&](const LaneSettings& lane) { return lane.detector == verdict.detector; });
    if (same == settings_.lanes.end() || verdict.unit != settings_.unit) ++counters_.foreign;
    else corroboration_.on_verdict(static_cast<LaneIndex>(same - settings_.lanes.begin()), verdict, timeline_.newest(), now_ns);
}

std::optional<LaneIndex> Frames::lane_of(std::uint32_t lane_id) const
{
    for (LaneIndex index = 0; index < settings_.lanes.size(); ++index) {
        if (settings_.lanes[index].lane == lane_id) return index;
    }
    return std::nullopt;
}

std::optional<Identity> Frames::newest() const
{
    return timeline_.started() ? std::optional(timeline_.newest()) : std::nullopt;
}

void Frames::receive(LaneIndex lane, const AttitudeState& attitude, std::int64_t now_ns)
{
    const Identity identity = identity_of(attitude);
    const Timeline::Arrival arrival = timeline_.classify(identity, now_ns);
    if (arrival == Timeline::Arrival::old) {
        ++counters_.late;
        return;
    }
    if (arrival == Timeline::Arrival::ahead) {
        if (timeline_.started()) ++counters_.foreign;
        newcomers_.hold(lane, attitude, now_ns);
        return;
    }
    first_received_ = std::min(first_received_.value_or(identity), identity);
    newcomers_.expected(lane, !board_.lane(lane).blocked(), now_ns);
    if (!board_.store(lane, attitude)) {
        ++counters_.duplicates;
        return;
    }
    if (&board_.lane(lane).newest() == board_.lane(lane).at(identity)) corroboration_.on_sample(lane, attitude, now_ns);
    if (arrival == Timeline::Arrival::late) {
        const bool missed = now_ns > timeline_.due_ns(identity.sequence) + durations_.patience_ns;  // else the others were quicker
        counters_.late += missed ? 1 : 0;
        board_.late_vote(lane, attitude, now_ns);
    } else if (is_countable(attitude)) {
        timeline_.open(identity, now_ns);
    }
}

void Frames::start(Identity first, std::optional<Identity> published, std::int64_t now_ns)
{
    if (timeline_.epoch() != first.epoch) narrator_.epoch(first, timeline_.epoch());
    timeline_.start(first, now_ns);
    first_received_ = newcomers_.begin(first);
    if (published) timeline_.pass(*published);
    for (LaneIndex lane = 0; lane < board_.size(); ++lane) {
        if (const auto held = newcomers_.take(lane, first)) receive(lane, *held, now_ns);
    }
}

void Frames::judge_silence(std::int64_t now_ns)
{
    board_.mark_silent(timeline_, durations_.silence_ns, now_ns);
    board_.release_last_resort(timeline_);
}

Ballot Frames::ballot(std::uint64_t sequence, LaneIndex wanted, LaneIndex current, std::int64_t now_ns) const
{
    const Identity identity = timeline_.identity(sequence);
    BallotPaper paper;
    paper.lanes = board_.size();
    for (LaneIndex lane = 0; lane < paper.lanes; ++lane) {
        const AttitudeState* sample = board_.lane(lane).at(identity);
        paper.sample[lane] = sample != nullptr && is_countable(*sample) ? sample : nullptr;
    }
    paper.corroborated = corroboration_.corroborated(now_ns);
    paper.blocked = board_.blocked() | using_condemned_axes(paper);
    paper.majority = majority_;
    paper.unseeded_remain = board_.unseeded_remain();
    paper.settling = corroboration_.settling(identity);
    paper.wanted = wanted;
    paper.current = current;
    return count(paper, board_.agreement());
}

/// Lanes that still use what a majority reports and a living lane leaves out. Their samples are never the output, even where no other lane
/// has delivered this frame yet: the frame waits for the lanes that know better, until those are silent. Where one of those delivered this
/// frame before it knew, no lane will correct it: it is published rather than left out, contaminated for as many frames as isolation took.
LaneMask Frames::using_condemned_axes(const BallotPaper& paper) const
{
    AxisMask known = 0, known_too_late = 0;
    for (LaneIndex lane = 0; lane < paper.lanes; ++lane) {
        if (board_.lane(lane).blocked()) continue;
        known |= corroboration_.held_out(lane);
        if (paper.sample[lane] != nullptr) known_too_late |= board_.lane(lane).newest().isolated_mask & ~left_out_mask(*paper.sample[lane]);
    }
    const AxisMask condemned = paper.corroborated & known & ~known_too_late;
    LaneMask lanes = 0;
    for (LaneIndex lane = 0; lane < paper.lanes; ++lane) {
        if (paper.sample[lane] != nullptr && (condemned & ~left_out_mask(*paper.sample[lane])) != 0) lanes |= lane_bit(lane);
    }
    return lanes;
}

bool Frames::is_ready(std::uint64_t sequence, const Ballot& ballot, LaneIndex wanted, std::int64_t not_before_ns, std::int64_t now_ns) const
{
    const Identity identity = timeline_.identity(sequence);
    if (ballot.backed && *ballot.primary == wanted && !is_better_to_come(identity, ballot.left_out, now_ns)) return true;
    if (is_complete(identity, ballot.several_groups, now_ns)) return true;
    return now_ns >= std::max(timeline_.due_ns(sequence) + durations_.patience_ns, not_before_ns);
}

/// A lane that has not delivered this frame yet has corrected its attitude for a fault that a majority of detectors reports.
bool Frames::is_better_to_come(Identity identity, AxisMask left_out, std::int64_t now_ns) const
{
    for (LaneIndex lane = 0; lane < board_.size(); ++lane) {
        if (board_.lane(lane).blocked() || board_.lane(lane).is_past(identity)) continue;
        if (corroboration_.knows_better(lane, left_out, now_ns)) return true;
    }
    return false;
}

/// Every lane that counts has delivered this frame or a later one, and every detector whose report could decide between groups as well.
bool Frames::is_complete(Identity identity, bool several_groups, std::int64_t now_ns) const
{
    for (LaneIndex lane = 0; lane < board_.size(); ++lane) {
        if (board_.lane(lane).blocked()) continue;
        if (!board_.lane(lane).is_past(identity)) return false;
        if (several_groups && corroboration_.reports(lane, now_ns) && !corroboration_.has_judged(lane, identity)) return false;
    }
    return true;
}

void Frames::publish(std::uint64_t sequence, const Ballot& ballot, std::int64_t now_ns)
{
    const Identity identity = timeline_.identity(sequence);
    const bool on_votes = ballot.backed || is_complete(identity, ballot.several_groups, now_ns);
    board_.publish(identity, ballot, board_.unseeded_remain(), now_ns);
    timeline_.publish(sequence, on_votes, now_ns);
}

void Frames::conclude(Identity published, std::int64_t now_ns)
{
    corroboration_.on_published(published, now_ns);
    board_.close(published);
}

VoteLevel Frames::level(LaneIndex primary) const
{
    return board_.levels().level(board_.excluded(), !corroboration_.redundancy_exhausted(primary));
}

}  // namespace quorient::voting
