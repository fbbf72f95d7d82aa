#include "quorient/attitude/integrator.hpp"

#include "announcement.hpp"
#include "frame_stream.hpp"
#include "integration.hpp"
#include "quorient/messages/left_out.hpp"
#include "quorient/messages/meaning.hpp"
#include "start.hpp"
#include "trust.hpp"

#include <algorithm>
#include <cmath>

namespace quorient::attitude {
namespace {

/// An integrator that missed so many frames asks whether the other lanes know better what turned meanwhile.
constexpr std::uint64_t frames_of_absence = 5;

/// They do if their standard deviation is so many times smaller. If all lanes missed the same frames, it is not.
constexpr double much_surer = 4;

/// The oldest frame that a verdict may correct needs the samples before it too.
std::size_t capacity_of(const IntegratorSettings& settings, const geometry::SensorCluster& cluster, const Update& update)
{
    return static_cast<std::size_t>(std::ceil(settings.history_s / cluster.interval_s)) + update.memory() + 1;
}

}  // namespace

tl::expected<Integrator, std::string> Integrator::make(const IntegratorSettings& settings, const geometry::SensorCluster& cluster)
{
    if (const std::string wrong = problem_of(settings, cluster); !wrong.empty()) return tl::unexpected(wrong);
    auto update = make_update(settings.algorithm);
    if (!update) return tl::unexpected(update.error());
    return Integrator(settings, cluster, std::move(*update));
}

Integrator::Integrator(const IntegratorSettings& settings, const geometry::SensorCluster& cluster, std::unique_ptr<const Update> update)
    : settings_(settings),
      body_(cluster),
      stream_(std::make_unique<FrameStream>(cluster.size())),
      trust_(std::make_unique<Trust>()),
      start_(std::make_unique<Start>(settings.initialised))
{
    const Standing start = stated(from_array(settings.initial_attitude).normalized());
    history_ = std::make_unique<History>(capacity_of(settings, cluster, *update), start);
    integration_ = std::make_unique<Integration>(std::move(update), cluster.interval_s, settings.lost_after_s);
    announcement_ = std::make_unique<Announcement>(start);
}

Integrator::Integrator(Integrator&&) noexcept = default;
Integrator& Integrator::operator=(Integrator&&) noexcept = default;
Integrator::~Integrator() = default;

// Frames.

void Integrator::add(const SensorFrame& frame)
{
    if (stream_->has_passed(identity_of(frame))) return;
    if (!stream_->is_epoch(frame.epoch)) enter_epoch(frame.epoch);
    if (integration_->has_caught_up(*history_)) announcement_->forget_rolled_back();
    announcement_->publish();

    if (stream_->lost_before(frame) > 0) bridge(frame);
    stream_->write_frame(frame, append_record());
    integrate_newest();
    stream_->take(frame);
    connect_seed();
    work();
}

void Integrator::enter_epoch(std::uint64_t epoch)
{
    const bool first = !stream_->has_epoch();
    const Quaternion* stated_attitude = start_->stated_for(epoch);
    stream_->begin_epoch(epoch);
    trust_->begin_epoch(epoch);

    Standing start = announcement_->shown();
    start.count = 0;
    if (stated_attitude) {
        start = stated(*stated_attitude);
        start_->on_stated_epoch();
    } else if (!first) {
        start.alignment = Alignment::lost;
    }
    history_->restart(start, {});
    history_->know_before(trust_->excluded_at(0));
    integration_->restart();
    trust_->fold(*history_);
    announcement_->begin(start, stated_attitude != nullptr && !first);
    verdict_applied_ = {};
}

void Integrator::bridge(const SensorFrame& frame)
{
    if (stream_->knowledge() == FrameStream::Knowledge::place) start_->on_lost_track();
    else if (stream_->next_sequence() > 0 && stream_->lost_before(frame) >= frames_of_absence) start_->on_absence(identity_of(frame));
    stream_->write_gap(frame, append_record());
    integrate_newest();
}

// What leaves must have been integrated: the next record stands on it.
Record& Integrator::append_record()
{
    if (history_->full()) {
        if (integration_->cursor() == 0) integration_->step(*history_);
        if (history_->oldest().own_opinion) trust_->keep_old(history_->oldest().opinion);
        history_->drop_oldest();
        integration_->forget_oldest();
    }
    return history_->append();
}

void Integrator::integrate_newest()
{
    const std::size_t index = history_->size() - 1;
    Record& record = (*history_)[index];
    record.own_opinion = trust_->take_early(record.first_sequence, record.last_sequence, record.opinion);
    history_->carry_opinions(index);

    if (trust_->has_early() && trust_->ever_excluded() && settings_.rollback) {
        trust_->fold(*history_);
    } else {
        record.excluded = trust_->excluded_at(record.last_sequence);
        record.isolated = trust_->isolated_at(record.last_sequence);
    }
    judge_record(record);
    announcement_->one_more_record();

    if (integration_->cursor() == index) {
        integration_->step(*history_);
        announcement_->show(record.standing);
        start_->on_caught_up();
    } else {
        announcement_->show(integration_->follow(announcement_->shown(), record));
    }
}

// Nothing in the oldest `count` records can be corrected any more; what follows stands on this. The exclusions stay in force.
void Integrator::close_history(std::size_t count, const Standing& standing)
{
    for (; count > 0; --count) {
        if (history_->oldest().own_opinion) trust_->keep_old(history_->oldest().opinion);
        history_->drop_oldest();
    }
    history_->begin_at(standing);
    integration_->restart();
    announcement_->at_most(history_->size());
}

Standing Integrator::stated(const Quaternion& attitude) const
{
    Standing standing;
    standing.attitude = attitude;
    standing.variance = settings_.initial_sigma_rad * settings_.initial_sigma_rad;
    return standing;
}

// Verdicts.

void Integrator::apply(const FaultVerdict& verdict)
{
    Opinion opinion = opinion_of(verdict);
    if (opinion.state == VerdictState::unknown || stream_->has_passed_epoch(verdict.epoch)) return;
    trust_->complete(opinion);
    if (!stream_->is_epoch(verdict.epoch)) return trust_->keep_early(verdict.epoch, opinion);

    const bool changes = trust_->changes(opinion) || identity_of(verdict) < verdict_applied_;
    verdict_applied_ = std::max(verdict_applied_, identity_of(verdict));
    std::size_t begin = history_->size();
    std::size_t end = history_->size();
    if (opinion.sequence >= stream_->next_sequence()) {
        trust_->keep_early(verdict.epoch, opinion);
    } else if (const std::size_t at = history_->find(opinion.sequence); at == history_->size()) {
        trust_->keep_old(opinion);
    } else {
        if (!history_->place(opinion, at)) return;
        begin = at;
        end = history_->carry_opinions(at);
    }
    if (changes && trust_->ever_excluded()) {
        refold();
        begin = 0;
        end = history_->size();
    }
    if (!settings_.rollback) return;
    integration_->go_back_to(*history_, refresh(begin, end));
    work();
}

void Integrator::refold()
{
    const std::size_t first = integration_->first_restorable(*history_, 0);
    const bool partly_gone = history_->is_cut() && first < history_->size();
    const AxisMask before = partly_gone ? (*history_)[first].excluded : 0;
    trust_->fold(*history_);
    if (!partly_gone || !settings_.rollback) return;
    const Record& edge = (*history_)[first];
    if ((edge.excluded & ~before & trust_->excluded_before(edge.first_sequence)) != 0) ++history_too_short_;
}

// @returns the first record of [begin, end) with which something else is done than before; history size if none.
std::size_t Integrator::refresh(std::size_t begin, std::size_t end)
{
    std::size_t changed = history_->size();
    for (std::size_t i = begin; i < end; ++i) {
        Record& record = (*history_)[i];
        const Judgement before = record.judgement;
        judge_record(record);
        if (record.judgement != before) changed = std::min(changed, i);
    }
    return changed;
}

void Integrator::judge_record(Record& record)
{
    const AxisMask used_before = record.judgement.used;
    record.judgement = judge(record.opinion, record.excluded, record.valid, settings_.leave_out_suspects, body_);
    if (record.judgement.used != used_before) record.combine(body_.solve(record.judgement.used));
}

bool Integrator::work()
{
    if (integration_->has_caught_up(*history_)) return false;
    integration_->catch_up(*history_);
    if (integration_->has_caught_up(*history_)) finish_correction();
    return !integration_->has_caught_up(*history_);
}

void Integrator::finish_correction()
{
    const Quaternion& corrected = history_->standing_before(history_->size() - announcement_->unpublished()).attitude;
    const bool announced = !start_->is_initialising();
    if (!history_->empty()) start_->on_caught_up();
    announcement_->correct(history_->standing_before(history_->size()), corrected, integration_->take_integrated_again(), announced);
}

// Starts.

bool Integrator::reset(const std::array<double, 4>& attitude, std::uint64_t sequence)
{
    const std::size_t at = stream_->has_epoch() ? history_->find(sequence) : history_->size();
    if (at == history_->size() || (*history_)[at].last_sequence != sequence) return false;
    Standing standing = stated(from_array(attitude).normalized());
    standing.rate_rad_s = (*history_)[at].standing.rate_rad_s;
    close_history(at + 1, standing);
    start_->on_reset();
    if (history_->empty()) finish_correction();
    else work();
    return true;
}

void Integrator::begin_epoch(std::uint64_t epoch, const std::array<double, 4>& attitude)
{
    start_->state_epoch(epoch, from_array(attitude).normalized());
}

Integrator::Mending Integrator::on_voted(const VotedAttitude& voted)
{
    if (!start_->is_newest(voted)) return {};
    const bool of_others = voted.primary_lane != settings_.lane;
    const auto vouched = vouched_exclusions(voted);
    if (vouched && of_others) trust_->let_go(~vouched->mask());
    if (start_->is_initialising() || !stream_->has_epoch()) {
        seed(voted);
        return {};
    }
    Mending mending;
    if (vouched && of_others && mends(voted)) {
        const AxisMask axes = faulty_in_seed();
        if (seed(voted)) mending = {true, axes};
    }
    const bool of_living = vouched || level_of(voted) == VoteLevel::single;
    if (of_living && start_->ends_absence(voted) && of_others && knows_better_after_absence(voted)) seed(voted);
    return mending;
}

// What was taken over between the beginning of a fault and its isolation has the fault in it. The other lanes have corrected themselves
// since.
bool Integrator::mends(const VotedAttitude& voted) const
{
    if (!start_->is_seeded()) return false;
    if (const AxisMask faulty = faulty_in_seed(); faulty != 0) return (faulty & ~left_out_mask(voted)) == 0;
    return start_->seed_was_untrusted() && mode_of(voted) == AttitudeMode::normal && mode_of(state()) == AttitudeMode::untrusted;
}

// The bridge over frames that this process missed lacks the coning in them, and perhaps that all instruments were saturated.
bool Integrator::knows_better_after_absence(const VotedAttitude& voted) const
{
    const AttitudeState own = state();
    const bool warns = mode_of(voted) == AttitudeMode::untrusted && mode_of(own) == AttitudeMode::normal;
    return warns || voted.angle_sigma_rad * much_surer < own.angle_sigma_rad;
}

// Axes that the newest verdict excludes from the seed's frame on or before, and the voters did not. No roll-back reaches there.
AxisMask Integrator::faulty_in_seed() const
{
    const Identity frame = start_->seed_frame();
    if (!start_->is_seeded() || !stream_->is_epoch(frame.epoch)) return 0;
    return trust_->unknown_to_voters(frame.sequence);
}

// @returns whether it was taken over now; if not, it may be later.
bool Integrator::seed(const VotedAttitude& voted)
{
    if (stream_->has_passed_epoch(voted.epoch)) return false;
    start_->wait_for(voted);
    const bool connected = connect_seed();
    work();
    return connected;
}

// A seed connects to a frame of the history, to the one just before it, or to the next frame where none has come in its epoch.
bool Integrator::connect_seed()
{
    const VotedAttitude* voted = start_->waiting_seed();
    if (!voted) return false;
    if (!stream_->has_epoch() || voted->epoch > stream_->epoch()) {
        stream_->go_on_after(identity_of(*voted));
        trust_->begin_epoch(voted->epoch);
        history_->restart(standing_of(*voted), {});
        history_->know_before(trust_->excluded_at(0));
        start_from(*voted, 0);
        return true;
    }
    if (voted->sequence >= stream_->next_sequence()) return false;

    const std::size_t at = history_->find(voted->sequence);
    const bool at_its_end = at < history_->size() && (*history_)[at].last_sequence == voted->sequence;
    const bool just_before = at == history_->size() && !history_->empty() && history_->oldest().first_sequence == voted->sequence + 1;
    const bool unknown_rotation = just_before && history_->oldest().bridge && history_->oldest().valid == 0;
    if (at_its_end || (just_before && !unknown_rotation)) {
        start_from(*voted, at_its_end ? at + 1 : 0);
        return true;
    }
    start_->drop_seed();
    return false;
}

void Integrator::start_from(const VotedAttitude& voted, std::size_t first_record)
{
    close_history(first_record, standing_of(voted));
    trust_->take_over(voted, *history_);
    announcement_->show(history_->standing_before(history_->size()));
    announcement_->take_over(voted.reset_counter, from_array(voted.reset_rotation));
    trust_->fold(*history_);
    history_->carry_opinions(0);
    refresh(0, history_->size());
    start_->on_seed_connected();
}

// Output.

AttitudeState Integrator::publish()
{
    announcement_->publish();
    return state();
}

AttitudeState Integrator::state() const
{
    AttitudeState state;
    state.unit = settings_.unit;
    state.lane = settings_.lane;
    state.epoch = stream_->epoch();
    state.sequence = stream_->next_sequence() == 0 ? 0 : stream_->next_sequence() - 1;
    state.sample_time_ns = stream_->sample_time_ns();
    state.verdict_epoch = verdict_applied_.epoch;
    state.verdict_sequence = verdict_applied_.sequence;
    state.excluded_from = trust_->latest_from();
    state.seeded = start_->is_seeded() ? 1 : 0;
    state.bridged = stream_->is_bridged() ? 1 : 0;
    announcement_->write(state);

    const Standing& shown = announcement_->shown();
    AttitudeMode mode = AttitudeMode::normal;
    double variance = shown.variance + shown.systematic_rad * shown.systematic_rad;
    if (!history_->empty()) {
        const Record& newest = history_->newest();
        mode = newest.judgement.mode;
        const Eigen::Vector3d rate = newest.body / newest.interval_s;
        state.rate_rad_s = {rate.x(), rate.y(), rate.z()};
        state.used_mask = newest.judgement.used;
        state.isolated_mask = newest.isolated;
        state.suspect_mask = newest.opinion.suspects & ~newest.excluded;
        variance += newest.quantum_variance;
    }
    if (shown.alignment == Alignment::untrusted) mode = AttitudeMode::untrusted;
    if (shown.alignment == Alignment::lost) mode = AttitudeMode::lost;
    if (start_->is_initialising() || !stream_->has_epoch()) mode = AttitudeMode::initialising;
    state.mode = octet(mode);
    state.angle_sigma_rad = std::sqrt(variance);
    return state;
}

}  // namespace quorient::attitude
