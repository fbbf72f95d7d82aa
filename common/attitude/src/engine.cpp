#include "engine.hpp"
#include "quorient/messages/meaning.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>

namespace quorient::attitude {
namespace {

// While nothing is known of the rotation it is taken to go on as before, and never to be slower than this.
constexpr double slowest_coasting_rad_s = 0.01;

}  // namespace

Integrator::Engine::Engine(const IntegratorSettings& settings, std::unique_ptr<const Update> update, const geometry::SensorCluster& cluster,
                           std::size_t capacity)
    : settings_(settings),
      update_(std::move(update)),
      body_(cluster),
      axis_count_(cluster.size()),
      nominal_interval_s_(cluster.interval_s),
      history_(capacity),
      initialised_(settings.initialised)
{
    anchor_.attitude = from_array(settings.initial_attitude).normalized();
    anchor_.variance = settings.initial_sigma_rad * settings.initial_sigma_rad;
    public_ = anchor_;
    announced_ = public_.attitude;
}

void Integrator::Engine::apply(const FaultVerdict& verdict)
{
    Opinion opinion = opinion_of(verdict);
    if (opinion.state == VerdictState::unknown || (epoch_known_ && verdict.epoch < epoch_)) return;
    confirm(opinion);
    exclusions_known_ = exclusions_known_ || opinion.excluded != 0;
    if (!epoch_known_ || verdict.epoch > epoch_) return trust_.hear_early(verdict.epoch, opinion);

    const bool news = opinion.excluded_from != trust_.latest_from() || identity_of(verdict) < verdict_applied_;
    verdict_applied_ = std::max(verdict_applied_, identity_of(verdict));
    std::size_t begin = history_.size();
    std::size_t end = history_.size();
    if (opinion.sequence >= next_sequence_) {
        trust_.hear_early(verdict.epoch, opinion);
    } else if (const std::size_t at = history_.find(opinion.sequence); at == history_.size()) {
        trust_.hear_old(opinion);
    } else {
        if (!hear(opinion, at)) return;
        begin = at;
        end = carry_opinion(at);
    }
    if (news && exclusions_known_) {
        refold();
        begin = 0;
        end = history_.size();
    }
    if (!settings_.rollback) return;
    go_back_to(refresh(begin, end));
    if (!caught_up()) work();
}

// The lane's detector may have been away when the fault began, and unable to name it now: until it has had an exclusion of its own, its
// verdicts do not clear the one that was taken over.
void Integrator::Engine::confirm(Opinion& opinion)
{
    unconfirmed_ &= ~opinion.excluded;
    opinion.take_over(taken_over_, unconfirmed_);
}

// @returns false where the record has this opinion, or a newer one, already.
bool Integrator::Engine::hear(const Opinion& opinion, std::size_t index)
{
    Record& record = history_[index];
    if (record.own_opinion) {
        const Opinion& known = record.opinion;
        if (known.sequence > opinion.sequence || (known.sequence == opinion.sequence && !opinion.precedes(known))) return false;
    }
    record.opinion = opinion;
    record.own_opinion = true;
    return true;
}

// An opinion stays in force until the next frame that has its own, and what it knows until one that may clear it.
// @returns the first record that this does not touch.
std::size_t Integrator::Engine::carry_opinion(std::size_t index)
{
    for (; index < history_.size(); ++index) {
        const Opinion& before = index == 0 ? carried_ : history_[index - 1].opinion;
        Record& record = history_[index];
        if (record.own_opinion) record.opinion.follow(before.known);
        else record.opinion = before;
        const bool next_is_apart = index + 1 < history_.size() && history_[index + 1].own_opinion && history_[index + 1].opinion.clears();
        if (next_is_apart) return index + 1;
    }
    return index;
}

void Integrator::Engine::refold()
{
    const std::size_t first = first_restorable(0);
    const bool partly_gone = history_dropped_ && first < history_.size();
    const AxisMask before = partly_gone ? history_[first].excluded : 0;
    trust_.fold(history_);
    if (!partly_gone || !settings_.rollback) return;
    const AxisMask new_at_edge = history_[first].excluded & ~before;
    if ((new_at_edge & trust_.excluded_before(history_[first].first_sequence)) != 0) ++history_too_short_;
}

// @returns the first record of [begin, end) with which something else is done than before; history size if none.
std::size_t Integrator::Engine::refresh(std::size_t begin, std::size_t end)
{
    std::size_t changed = history_.size();
    for (std::size_t i = begin; i < end; ++i) {
        Record& record = history_[i];
        const Judgement before = record.judgement;
        judge_record(record);
        if (record.judgement != before) changed = std::min(changed, i);
    }
    return changed;
}

void Integrator::Engine::judge_record(Record& record)
{
    const Judgement before = record.judgement;
    record.judgement = judge(record.opinion, record.excluded, record.valid, settings_.leave_out_suspects, body_);
    if (record.judgement.used == before.used) return;
    const auto& gain = body_.solve(record.judgement.used).gain;
    record.body.setZero();
    for (std::size_t axis = 0; axis < max_axes; ++axis) record.body += gain.col(static_cast<Eigen::Index>(axis)) * record.increment[axis];
}

// The samples that an update looks back at must still be there.
std::size_t Integrator::Engine::first_restorable(std::size_t index) const
{
    while (index < history_.size() && index + 1 < std::min<std::uint64_t>(history_[index].standing.count, update_->memory())) ++index;
    return index;
}

void Integrator::Engine::go_back_to(std::size_t index)
{
    index = first_restorable(index);
    if (index >= cursor_) return;
    cursor_ = index;
    window_size_ = 0;
}

bool Integrator::Engine::work()
{
    if (caught_up()) return false;
    for (std::size_t done = 0; done < slice && !caught_up(); ++done) {
        integrate(cursor_++);
        ++integrated_again_;
    }
    if (caught_up()) finish_correction();
    return !caught_up();
}

void Integrator::Engine::finish_correction()
{
    public_ = before(history_.size());
    const Quaternion& corrected = before(history_.size() - unpublished_).attitude;
    if (catching_up_) {
        catching_up_ = history_.empty();
    } else if (initialised_ && corrected.coeffs() != announced_.coeffs()) {
        ++reset_counter_;
        reset_rotation_ = renormalised(corrected * announced_.conjugate());
        rolled_back_frames_ += static_cast<std::uint32_t>(integrated_again_ - std::min(integrated_again_, unpublished_));
    }
    announced_ = corrected;
    integrated_again_ = 0;
}

void Integrator::Engine::mark_published()
{
    announced_ = public_.attitude;
    unpublished_ = 0;
}

void Integrator::Engine::integrate(std::size_t index)
{
    Record& record = history_[index];
    Standing now = before(index);
    const bool goes_on = now.count > 0 && same_start(now.interval_s, record.interval_s);
    const Quaternion held = now.attitude;
    grow(now, record);
    now.count = record.judgement.used == 0 ? 0 : goes_on ? now.count + 1 : 1;

    if (now.count == 0) {
        window_size_ = 0;
    } else {
        gather_window(index, static_cast<std::size_t>(std::min<std::uint64_t>(now.count, update_->memory())) - 1);
        window_[window_size_++] = {record.body, record.interval_s};
        const Step step = update_->step(now.count, std::span(window_).first(window_size_));
        now.attitude = renormalised(attitude_back(index, step.span) * step.rotation);
        if (record.bridge) {
            // The coning inside a gap is at best a guess from its neighbours, and over a long gap none: it counts as uncertainty.
            const double guess = angle_between(held * from_rotation_vector(record.body), now.attitude);
            now.systematic_rad += std::max(guess, record.body.squaredNorm() / 12);
        }
    }
    window_end_ = index + 1;
    record.standing = now;
}

// All of a standing but its attitude and count.
void Integrator::Engine::grow(Standing& standing, const Record& record) const
{
    standing.interval_s = record.interval_s;
    if (record.judgement.used == 0) {
        standing.coasting_s += record.interval_s;
        standing.lost = standing.lost || standing.coasting_s > settings_.lost_after_s;
        standing.systematic_rad += std::max(standing.rate_rad_s, slowest_coasting_rad_s) * record.interval_s;
        return;
    }
    standing.coasting_s = 0;
    standing.rate_rad_s = record.body.norm() / record.interval_s;
    standing.variance += body_.solve(record.judgement.used).variance * record.interval_s / nominal_interval_s_;
    standing.systematic_rad += record.judgement.doubt_rad;
}

// Leaves the newest `held` samples before this record in the window.
void Integrator::Engine::gather_window(std::size_t index, std::size_t held)
{
    if (window_end_ == index && window_size_ >= held) {
        const auto excess = static_cast<std::ptrdiff_t>(window_size_ - held);
        std::move(window_.begin() + excess, window_.begin() + static_cast<std::ptrdiff_t>(window_size_), window_.begin());
    } else {
        assert(held <= index);
        for (std::size_t i = 0; i < held; ++i) window_[i] = {history_[index - held + i].body, history_[index - held + i].interval_s};
    }
    window_size_ = held;
}

const Quaternion& Integrator::Engine::attitude_back(std::size_t index, std::size_t span) const
{
    assert(span <= index + 1);
    return before(index + 1 - span).attitude;
}

// Until the roll-back has caught up: the attitude as it was announced, turned on by what is trusted now.
void Integrator::Engine::follow_old_track(const Record& record)
{
    if (record.judgement.used != 0) public_.attitude = renormalised(public_.attitude * from_rotation_vector(record.body));
    grow(public_, record);
}

AttitudeState Integrator::Engine::state() const
{
    AttitudeState state;
    state.unit = settings_.unit;
    state.lane = settings_.lane;
    state.epoch = epoch_;
    state.sequence = next_sequence_ == 0 ? 0 : next_sequence_ - 1;
    state.sample_time_ns = sample_time_ns_;
    state.verdict_epoch = verdict_applied_.epoch;
    state.verdict_sequence = verdict_applied_.sequence;
    state.attitude = to_array(public_.attitude);
    state.reset_rotation = to_array(reset_rotation_);
    state.reset_counter = reset_counter_;
    state.rolled_back_frames = rolled_back_frames_;
    state.excluded_from = trust_.latest_from();
    state.seeded = seeded_ ? 1 : 0;
    state.bridged = bridged_ ? 1 : 0;

    AttitudeMode mode = AttitudeMode::normal;
    double variance = public_.variance + public_.systematic_rad * public_.systematic_rad;
    if (!history_.empty()) {
        const Record& newest = history_.newest();
        mode = newest.judgement.mode;
        const Eigen::Vector3d rate = newest.body / newest.interval_s;
        state.rate_rad_s = {rate.x(), rate.y(), rate.z()};
        state.used_mask = newest.judgement.used;
        state.isolated_mask = newest.excluded;
        state.suspect_mask = newest.opinion.suspects & ~newest.excluded;
        variance += body_.solve(newest.judgement.used).quantum_variance;
    }
    if (public_.lost) mode = AttitudeMode::lost;
    if (!initialised_ || catching_up_ || !epoch_known_) mode = AttitudeMode::initialising;
    state.mode = octet(mode);
    state.angle_sigma_rad = std::sqrt(variance);
    return state;
}

}  // namespace quorient::attitude
