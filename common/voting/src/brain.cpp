#include "brain.hpp"

#include "quorient/voting/nanoseconds.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

namespace quorient::voting {
namespace {

/// A publisher that restarts is silent for at least this long (design: max(5 intervals, 100 ms)).
constexpr std::int64_t least_grace_ns = 100'000'000;

/// A primary that the stronger voter names in so many frames running is its choice; in fewer it may be a stand-in for a late one.
constexpr std::uint64_t choice_frames = 5;

}  // namespace

Voter::Brain::Brain(const VoterSettings& settings)
    : settings_(settings),
      interval_ns_(std::max<std::int64_t>(1, nanoseconds(settings.interval_s))),
      patience_ns_(nanoseconds(settings.interval_s * settings.patience)),
      silence_ns_(nanoseconds(settings.interval_s * settings.silence_intervals)),
      lease_ns_(nanoseconds(settings.lease_s)),
      coasting_interval_ns_(nanoseconds(settings.coasting_interval_s)),
      coasting_to_lost_ns_(nanoseconds(settings.coasting_to_lost_s)),
      majority_(settings.lanes.size() / 2 + 1),
      narrator_(settings),
      timeline_(interval_ns_),
      newcomers_(settings.lanes.size(), majority_, std::max(silence_ns_, least_grace_ns)),
      corroboration_(settings.lanes.size(), majority_, settings.settle_frames, settings.return_frames, silence_ns_),
      board_(settings, majority_, corroboration_, narrator_),
      ranking_(settings),
      owned_(interval_ns_),
      joining_(settings, ranking_.has_others())
{
    promised_ns_ = std::numeric_limits<std::int64_t>::min();
}

void Voter::Brain::on_attitude(const AttitudeState& attitude, std::int64_t now_ns)
{
    notice(now_ns);
    const auto lane = lane_of(attitude.unit, attitude.lane, &LaneSettings::lane);
    if (!lane) {
        ++counters_.foreign;
    } else if (++counters_.received; is_sound(attitude)) {
        receive(*lane, attitude);
    } else {
        ++counters_.rejected;
        board_.reject(*lane, identity_of(attitude));
    }
    go_on();
}

void Voter::Brain::on_verdict(const FaultVerdict& verdict, std::int64_t now_ns)
{
    notice(now_ns);
    const auto lane = lane_of(verdict.unit, verdict.detector, &LaneSettings::detector);
    if (!lane) ++counters_.foreign;
    else corroboration_.on_verdict(*lane, verdict, timeline_.newest(), *now_);
    go_on();
}

void Voter::Brain::on_other_voter(const VotedAttitude& output, std::int64_t now_ns)
{
    notice(now_ns);
    const bool own = output.voter == settings_.voter && output.unit == settings_.unit;
    if (!own && !ranking_.on_output(output, *now_)) ++counters_.foreign;
    go_on();
}

void Voter::Brain::poll(std::int64_t now_ns)
{
    notice(now_ns);
    go_on();
}

bool Voter::Brain::may_own() const
{
    if (!ranking_.established() || joining_.listens()) return false;
    const bool repeats = coasted_ns_ > last_frame_ns_;
    return !repeats || !ranking_.is_behind(identity_of(last_), *now_);
}

/// Time goes on.
void Voter::Brain::notice(std::int64_t now_ns)
{
    if (!now_) {
        now_ = now_ns;
        return joining_.begin(now_ns);
    }
    const std::int64_t before = *now_;
    now_ = std::max(before, now_ns);
    const std::int64_t away_ns = *now_ - before;
    const std::int64_t mute_ns = std::max(away_ns, spoke_ns_ ? *now_ - *spoke_ns_ : 0);
    const bool late = *now_ > promised_ns_ + interval_ns_ / 2;
    if (away_ns > lease_ns_ || (late && joining_.may_be_replaced(mute_ns))) start_over(mute_ns);
    else if (late) joining_.was_delayed(*now_, away_ns);
}

void Voter::Brain::start_over(std::int64_t away_ns)
{
    ++counters_.resynchronised;
    narrator_.away(timeline_.newest(), seconds(away_ns));
    timeline_.forget_frames();
    spoke_ns_.reset();
    ranking_.start_over();
    joining_.start_over(*now_);
}

void Voter::Brain::finish_joining()
{
    if (joining_.finish()) timeline_.pass(timeline_.newest());
    if (const VotedAttitude* other = ranking_.farthest(*now_)) adopt(*other);
}

/// Goes on where the other voter is. What it only repeats is as old as this voter knows, and lost if that one says so.
void Voter::Brain::adopt(const VotedAttitude& output)
{
    if (continuity_.started() && identity_of(output) <= continuity_.identity()) return;
    continuity_.follow(output);
    timeline_.pass(identity_of(output));
    if (const auto lane = lane_of(output.unit, output.primary_lane, &LaneSettings::lane)) primary_ = *lane;
    last_ = output;
    const bool lost = output.mode == static_cast<std::uint8_t>(AttitudeMode::lost);
    last_frame_ns_ = lost ? *now_ - silence_ns_ - coasting_to_lost_ns_ : *now_;
}

std::optional<LaneIndex> Voter::Brain::lane_of(std::uint32_t unit, std::uint32_t id, std::uint32_t LaneSettings::*member) const
{
    if (unit != settings_.unit) return std::nullopt;
    for (LaneIndex index = 0; index < settings_.lanes.size(); ++index) {
        if (settings_.lanes[index].*member == id) return index;
    }
    return std::nullopt;
}

void Voter::Brain::receive(LaneIndex lane, const AttitudeState& attitude)
{
    const Identity identity = identity_of(attitude);
    const Timeline::Arrival arrival = timeline_.classify(identity, *now_);
    if (arrival == Timeline::Arrival::old) {
        ++counters_.late;
        return;
    }
    if (arrival == Timeline::Arrival::ahead) {
        if (timeline_.started()) ++counters_.foreign;
        newcomers_.hold(lane, attitude, *now_);
        return;
    }
    newcomers_.expected(lane, !board_.lane(lane).blocked(), *now_);
    if (!board_.store(lane, attitude)) {
        ++counters_.duplicates;
        return;
    }
    if (&board_.lane(lane).newest() == board_.lane(lane).at(identity)) corroboration_.on_sample(lane, attitude, *now_);
    if (arrival == Timeline::Arrival::late) {
        ++counters_.late;
        board_.late_vote(lane, attitude, *now_);
    } else if (is_countable(attitude)) {
        timeline_.open(identity, *now_);
    }
}

void Voter::Brain::consider_newcomers()
{
    const auto start = newcomers_.accepted(*now_);
    if (!start) return;
    publish_what_is_ready(true);
    if (timeline_.epoch() != start->epoch) narrator_.epoch(*start, timeline_.epoch());
    timeline_.start(*start, *now_);
    if (continuity_.started()) timeline_.pass(continuity_.identity());
    for (LaneIndex lane = 0; lane < board_.size(); ++lane) {
        if (const auto held = newcomers_.take(lane, *start)) receive(lane, *held);
    }
}

void Voter::Brain::go_on()
{
    consider_newcomers();
    if (joining_.is_over(*now_, timeline_, ranking_)) finish_joining();
    if (*now_ >= joining_.drained_ns()) {
        board_.mark_silent(timeline_, silence_ns_, *now_);
        board_.release_last_resort(timeline_);
    }
    if (!joining_.listens()) {
        publish_what_is_ready(false);
        coast_if_due();
    }
    owned_.release(ranking_, *now_);
    const bool owns = may_own() && ranking_.leader(*now_) == nullptr;
    if (owns && !owns_) narrator_.ownership(identity_of(last_), ranking_.has_stronger());
    owns_ = owns;
    plan();
}

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
/// this frame yet. The frame waits for those who know better, until they are silent.
LaneMask Voter::Brain::using_condemned_axes(const BallotPaper& paper) const
{
    AxisMask condemned = 0;
    for (LaneIndex lane = 0; lane < paper.lanes; ++lane) {
        if (!board_.lane(lane).blocked()) condemned |= corroboration_.held_out(lane);
    }
    condemned &= paper.corroborated;
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
        change_primary(identity, *ballot.primary, reset.moved ? geodesic_angle(reset.rotation, no_rotation) : 0);
    board_.publish(identity, ballot, board_.unseeded_remain(), *now_);
    timeline_.publish(sequence, on_votes, *now_);

    const bool lost = sample.mode == static_cast<std::uint8_t>(AttitudeMode::lost);
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
    output.level = static_cast<std::uint8_t>(level_);
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
    output.level = static_cast<std::uint8_t>(level_);
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

/// The earliest time at which something changes by itself. Never farther away than half a lease, so that an own delay is noticed.
void Voter::Brain::plan()
{
    std::int64_t earliest = *now_ + std::max<std::int64_t>(1, lease_ns_ / 2);
    const auto consider = [&](std::int64_t time_ns) {
        if (time_ns > *now_) earliest = std::min(earliest, time_ns);
    };
    joining_.tell_deadlines(consider);
    consider(owned_.deadline_ns());
    consider(newcomers_.deadline_ns());
    consider(ranking_.leader_ends_ns(*now_));
    consider(board_.silence_deadline_ns(timeline_, silence_ns_));
    for (auto waiting = timeline_.next_open(timeline_.next()); waiting; waiting = timeline_.next_open(*waiting + 1)) {
        consider(timeline_.due_ns(*waiting) + patience_ns_);
    }
    if (continuity_.started()) {
        consider(last_frame_ns_ + silence_ns_);
        if (coasted_ns_ > last_frame_ns_) consider(coasted_ns_ + coasting_interval_ns_);
    }
    promised_ns_ = earliest;
}

}  // namespace quorient::voting
