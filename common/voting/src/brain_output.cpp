// The output side of the voter: which frame is ready, whose attitude it is, and what is said while there are no frames.

#include "brain.hpp"

#include "quorient/messages/meaning.hpp"
#include "quorient/messages/time.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace quorient::voting {
namespace {

/// A primary that the stronger voter names in so many frames running is its choice; in fewer it may be a stand-in for a late one.
constexpr std::uint64_t choice_frames = 5;

}  // namespace

/// In order: a frame goes out before any later one. Frames of which only excluded lanes spoke are passed over with the next one.
void Voter::Brain::publish_what_is_ready(bool at_once)
{
    if (joining_.listens()) return;
    auto sequence = timeline_.next_open(timeline_.next());
    while (sequence) {
        const Ballot ballot = count(paper_of(*sequence), board_.agreement());
        if (ballot.primary) {
            if (!at_once && !is_ready(*sequence, ballot)) return;
            publish(*sequence, ballot);
        }
        sequence = timeline_.next_open(*sequence + 1);
    }
}

BallotPaper Voter::Brain::paper_of(std::uint64_t sequence) const
{
    const Identity identity = timeline_.identity(sequence);
    BallotPaper paper;
    paper.lanes = board_.size();
    for (LaneIndex lane = 0; lane < paper.lanes; ++lane) {
        const AttitudeState* sample = board_.lane(lane).at(identity);
        paper.sample[lane] = sample != nullptr && is_countable(*sample) ? sample : nullptr;
    }
    paper.corroborated = corroboration_.corroborated(*now_);
    paper.blocked = board_.blocked() | using_condemned_axes(paper);
    paper.majority = majority_;
    paper.unseeded_remain = board_.unseeded_remain();
    paper.settling = corroboration_.settling(identity);
    paper.wanted = wanted_primary();
    paper.current = primary_;
    return paper;
}

/// Lanes that still use what a majority reports and a living lane leaves out: never the output, even where nobody else has spoken of
/// this frame yet. The frame waits for those who know better, until they are silent. Where one of those spoke of this frame before it
/// knew, nobody will correct it: it goes out rather than be left out, contaminated for as many frames as isolation took.
LaneMask Voter::Brain::using_condemned_axes(const BallotPaper& paper) const
{
    AxisMask known = 0, known_too_late = 0;
    for (LaneIndex lane = 0; lane < paper.lanes; ++lane) {
        if (board_.lane(lane).blocked()) continue;
        known |= corroboration_.held_out(lane);
        if (paper.sample[lane] != nullptr) known_too_late |= board_.lane(lane).newest().isolated_mask & ~paper.sample[lane]->isolated_mask;
    }
    const AxisMask condemned = paper.corroborated & known & ~known_too_late;
    LaneMask lanes = 0;
    for (LaneIndex lane = 0; lane < paper.lanes; ++lane) {
        if (paper.sample[lane] != nullptr && (condemned & ~paper.sample[lane]->isolated_mask) != 0) lanes |= lane_bit(lane);
    }
    return lanes;
}

LaneIndex Voter::Brain::wanted_primary() const
{
    const auto leaders = ranking_.leaders_primary(choice_frames, *now_);
    if (!leaders) return primary_;
    const auto lane = lane_of(settings_.unit, *leaders, &LaneSettings::lane);
    return lane && !board_.lane(*lane).blocked() ? *lane : primary_;
}

/// The primary is only late: another lane speaks for it in this frame, until it is silent.
bool Voter::Brain::is_stand_in(Identity identity, LaneIndex lane) const
{
    const LaneIndex wanted = wanted_primary();
    return continuity_.started() && lane != wanted && !board_.lane(wanted).blocked() && board_.lane(wanted).at(identity) == nullptr;
}

bool Voter::Brain::is_ready(std::uint64_t sequence, const Ballot& ballot) const
{
    const bool as_wanted = ballot.backed && *ballot.primary == wanted_primary();
    if (as_wanted && !is_better_to_come(timeline_.identity(sequence), ballot.isolated)) return true;
    if (is_complete(timeline_.identity(sequence), ballot.several_groups)) return true;
    return *now_ >= std::max(timeline_.due_ns(sequence) + patience_ns_, joining_.drained_ns());
}

/// A lane that has not spoken of this frame yet has corrected its attitude for a fault that a majority of detectors reports.
bool Voter::Brain::is_better_to_come(Identity identity, AxisMask isolated) const
{
    for (LaneIndex lane = 0; lane < board_.size(); ++lane) {
        if (board_.lane(lane).blocked() || board_.lane(lane).is_past(identity)) continue;
        if (corroboration_.knows_better(lane, isolated, *now_)) return true;
    }
    return false;
}

/// Nobody whose voice could change the outcome is still to be heard.
bool Voter::Brain::is_complete(Identity identity, bool several_groups) const
{
    for (LaneIndex lane = 0; lane < board_.size(); ++lane) {
        if (board_.lane(lane).blocked()) continue;
        if (!board_.lane(lane).is_past(identity)) return false;
        if (several_groups && corroboration_.speaks(lane, *now_) && !corroboration_.has_judged(lane, identity)) return false;
    }
    return true;
}

void Voter::Brain::publish(std::uint64_t sequence, const Ballot& ballot)
{
    const Identity identity = timeline_.identity(sequence);
    const AttitudeState& sample = *board_.lane(*ballot.primary).at(identity);
    if (last_.epoch == identity.epoch && identity.sequence > last_.sequence + 1) counters_.gaps += identity.sequence - last_.sequence - 1;

    const bool on_votes = ballot.backed || is_complete(identity, ballot.several_groups);
    const Continuity::Reset reset = continue_stream(identity, sample);
    if (*ballot.primary != primary_ && !is_stand_in(identity, *ballot.primary))
        change_primary(identity, *ballot.primary, reset.moved ? angle_between(reset.rotation, no_rotation) : 0);
    board_.publish(identity, ballot, board_.unseeded_remain(), *now_);
    timeline_.publish(sequence, on_votes, *now_);

    const bool lost = mode_of(sample) == AttitudeMode::lost;
    const bool redundancy_left = !corroboration_.redundancy_exhausted(primary_);
    set_level(identity, lost ? VoteLevel::lost : board_.levels().level(board_.excluded(), redundancy_left));

    fill(last_, sample, ballot, reset);
    last_frame_ns_ = *now_;
    emit(last_, false);
    continuity_.follow(last_);
    corroboration_.on_published(identity, *now_);
    board_.close(identity);
}

Continuity::Reset Voter::Brain::continue_stream(Identity identity, const AttitudeState& sample)
{
    const VotedAttitude* before = ranking_.leader_before(identity, *now_);
    if (before != nullptr && (!continuity_.started() || identity_of(*before) >= continuity_.identity())) continuity_.follow(*before);
    const VotedAttitude* same = ranking_.leader_at(identity, *now_);
    const auto lane = lane_of(sample.unit, sample.lane, &LaneSettings::lane);
    Continuity::Reset reset = continuity_.next(sample, board_.lane(*lane).at(continuity_.identity()));
    if (same != nullptr && Continuity::is_same(same->attitude, sample.attitude)) {
        reset.counter = same->reset_counter;
        reset.rotation = same->reset_rotation;
    }
    return reset;
}

void Voter::Brain::change_primary(Identity identity, LaneIndex to, double moved_rad)
{
    const LaneIndex from = primary_;
    if (continuity_.started()) {
        change_[counters_.primary_changes % change_.size()] = counters_.published;
        const auto recent = std::count_if(change_.begin(), change_.end(), [this](std::uint64_t at) {
            return at != 0 && counters_.published - at < settings_.return_frames;
        });
        ++counters_.primary_changes;
        narrator_.primary_changed(identity, from, to, reason_to_leave(identity, to), moved_rad, static_cast<unsigned>(recent));
    }
    primary_ = to;
}

const char* Voter::Brain::reason_to_leave(Identity identity, LaneIndex to) const
{
    const VotedAttitude* leader = ranking_.leader(*now_);
    const LaneTracker& lane = board_.lane(primary_);
    if (lane.latched() == LaneExclusion::silent) return "it is silent";
    if (lane.blocked()) return "it is excluded";
    if (leader != nullptr && leader->primary_lane == settings_.lanes[to].lane) return "the stronger voter chose so";
    const AttitudeState* sample = lane.at(identity);
    if (sample == nullptr) return "its sample of this frame did not come in time";
    if (!is_countable(*sample)) return "it is initialising";
    if (sample->isolated_mask != board_.lane(to).at(identity)->isolated_mask) return "the detectors stand behind other axes";
    return "the majority contradicts it";
}

void Voter::Brain::fill(VotedAttitude& output, const AttitudeState& sample, const Ballot& ballot, const Continuity::Reset& reset) const
{
    output = {};
    output.epoch = sample.epoch;
    output.sequence = sample.sequence;
    output.sample_time_ns = sample.sample_time_ns;
    output.output_sequence = ranking_.next_output_sequence(identity_of(sample));
    output.attitude = sample.attitude;
    output.reset_rotation = reset.rotation;
    output.reset_counter = reset.counter;
    output.rate_rad_s = sample.rate_rad_s;
    output.angle_sigma_rad = sample.angle_sigma_rad;
    output.spread_rad = ballot.spread_rad;
    output.excluded_from = sample.excluded_from;
    output.stamp_ns = sample.stamp_ns;
    output.unit = settings_.unit;
    output.voter = settings_.voter;
    output.primary_lane = sample.lane;
    output.excluded_mask = board_.excluded();
    output.vouching_mask = ballot.vouching | (board_.levels().standing() & ~ballot.heard & ~output.excluded_mask);
    output.used_mask = sample.used_mask;
    output.isolated_mask = sample.isolated_mask;
    output.suspect_mask = sample.suspect_mask;
    for (LaneIndex lane = 0; lane < board_.size(); ++lane) output.excluded_why[lane] = static_cast<std::uint8_t>(board_.lane(lane).why());
    output.mode = sample.mode;
    output.level = octet(level_);
    output.seeded = sample.seeded;
    output.bridged = sample.bridged;
}

/// No frames: the last attitude again and again, ever less certain, so that nobody takes silence for an answer.
void Voter::Brain::coast_if_due()
{
    if (!continuity_.started() || *now_ - last_frame_ns_ < silence_ns_) return;
    if (coasted_ns_ > last_frame_ns_ && *now_ - coasted_ns_ < coasting_interval_ns_) return;
    coasted_ns_ = *now_;
    const bool lost = *now_ - last_frame_ns_ >= silence_ns_ + coasting_to_lost_ns_;
    if (lost) board_.start_levels_over();
    set_level(identity_of(last_), lost ? VoteLevel::lost : VoteLevel::coasting);

    VotedAttitude output = last_;
    const double rate_rad_s = std::hypot(last_.rate_rad_s[0], last_.rate_rad_s[1], last_.rate_rad_s[2]) + settings_.coasting_rate_rad_s;
    output.angle_sigma_rad = std::min(std::numbers::pi, last_.angle_sigma_rad + rate_rad_s * seconds(*now_ - last_frame_ns_));
    output.voter = settings_.voter;
    output.output_sequence = ranking_.next_output_sequence(identity_of(last_));
    output.mode = static_cast<std::uint8_t>(lost ? AttitudeMode::lost : AttitudeMode::coasting);
    output.level = octet(level_);
    output.vouching_mask = 0;
    output.spread_rad = 0;
    emit(output, true);
}

void Voter::Brain::emit(const VotedAttitude& attitude, bool repeated)
{
    outputs_.push().attitude = attitude;
    ranking_.published(attitude.output_sequence);
    owned_.push(attitude, repeated, *now_);
    spoke_ns_ = repeated ? std::nullopt : now_;  // between repetitions a voter is alive by assertion alone
    ++counters_.published;
}

void Voter::Brain::set_level(Identity identity, VoteLevel level)
{
    if (level == level_) return;
    narrator_.level(identity, level_, level, board_.levels().standing() & ~board_.excluded());
    level_ = level;
}

}  // namespace quorient::voting
