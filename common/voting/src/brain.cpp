#include "brain.hpp"

#include "quorient/messages/meaning.hpp"
#include "quorient/messages/time.hpp"

#include <algorithm>
#include <limits>

namespace quorient::voting {
namespace {

/// A publisher that restarts is silent for at least this long (design: max(5 intervals, 100 ms)).
constexpr std::int64_t least_grace_ns = 100'000'000;

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
    const bool lost = mode_of(output) == AttitudeMode::lost;
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
