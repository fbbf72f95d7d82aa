#include "engine.hpp"

#include <algorithm>
#include <cmath>

namespace quorient::attitude {
namespace {

// Beyond this it is no rotation of one interval, and its square would leave the range of a double.
constexpr double largest_increment = 1e6;

bool usable(double increment)
{
    return std::abs(increment) <= largest_increment;
}

Standing standing_of(const VotedAttitude& voted)
{
    Standing standing;
    standing.attitude = renormalised(from_array(voted.attitude));
    standing.variance = voted.angle_sigma_rad * voted.angle_sigma_rad;
    return standing;
}

}  // namespace

void Integrator::Engine::add(const SensorFrame& frame)
{
    if (epoch_known_ && Identity{frame.epoch, frame.sequence} < Identity{epoch_, next_sequence_}) return;
    if (!epoch_known_ || frame.epoch != epoch_) enter_epoch(frame.epoch);
    if (caught_up()) rolled_back_frames_ = 0;
    mark_published();

    const std::uint64_t lost = frame.sequence - next_sequence_;
    bridged_ = lost > 0;
    if (bridged_) {
        if (!accumulated_known_) initialised_ = seeded_ = false;  // nobody knows what turned since the seed: wait for another
        append_gap(frame, lost);
        integrate_appended();
    }
    append_frame(frame);
    integrate_appended();

    accumulated_ = frame.accumulated;
    missed_ = frame.missed;
    accumulated_known_ = true;
    next_sequence_ = frame.sequence + 1;
    sample_time_ns_ = frame.sample_time_ns;
    connect_seed();
    if (!caught_up()) work();
}

void Integrator::Engine::enter_epoch(std::uint64_t epoch)
{
    const bool first = !epoch_known_;
    epoch_ = epoch;
    epoch_known_ = true;
    next_sequence_ = 0;
    accumulated_.fill(0);
    missed_.fill(0);
    accumulated_known_ = true;
    const bool stated = start_known_ && start_epoch_ == epoch;
    history_.clear();
    history_dropped_ = false;
    trust_.begin_epoch(epoch);
    trust_.fold(history_);
    taken_over_.excluded_from = taken_over_.excluded_from.in_new_epoch();
    if (first && !stated) return;

    Standing start = public_;
    start.count = 0;
    start.lost = !stated;
    if (stated) {
        start = Standing{};
        start.attitude = start_attitude_;
        start.variance = settings_.initial_sigma_rad * settings_.initial_sigma_rad;
        if (!first) {
            ++reset_counter_;
            reset_rotation_ = renormalised(start.attitude * public_.attitude.conjugate());
        }
        initialised_ = true;
    }
    carried_ = Opinion{};
    carried_.known = trust_.excluded_at(0);
    cursor_ = window_end_ = window_size_ = 0;
    anchor_ = public_ = start;
    verdict_applied_ = {};
    mark_published();
}

void Integrator::Engine::append_gap(const SensorFrame& frame, std::uint64_t lost)
{
    Record& record = append_record();
    record.first_sequence = next_sequence_;
    record.last_sequence = frame.sequence - 1;
    record.interval_s = static_cast<double>(lost) * frame.interval_s;
    record.bridge = true;
    for (std::size_t axis = 0; axis < axis_count_; ++axis) {
        const bool own = has_axis(frame.valid_mask, axis);
        const double turned = frame.accumulated[axis] - accumulated_[axis] - (own ? frame.increment[axis] : 0);
        const bool complete = accumulated_known_ && frame.missed[axis] - missed_[axis] == (own ? 0U : 1U);
        if (!complete || !usable(turned)) continue;
        record.increment[axis] = turned;
        record.valid |= axis_bit(axis);
    }
}

void Integrator::Engine::append_frame(const SensorFrame& frame)
{
    Record& record = append_record();
    record.first_sequence = record.last_sequence = frame.sequence;
    record.interval_s = frame.interval_s;
    for (std::size_t axis = 0; axis < axis_count_; ++axis) {
        if (!has_axis(frame.valid_mask, axis) || !usable(frame.increment[axis])) continue;
        record.increment[axis] = frame.increment[axis];
        record.valid |= axis_bit(axis);
    }
}

Record& Integrator::Engine::append_record()
{
    if (history_.full()) drop_oldest();
    Record& record = history_.append();
    record = Record{};
    return record;
}

void Integrator::Engine::integrate_appended()
{
    const std::size_t index = history_.size() - 1;
    Record& record = history_[index];
    record.own_opinion = trust_.take_early(record.first_sequence, record.last_sequence, record.opinion);
    carry_opinion(index);

    if (trust_.waiting() && exclusions_known_ && settings_.rollback) trust_.fold(history_);
    else record.excluded = trust_.excluded_at(record.last_sequence);
    judge_record(record);
    ++unpublished_;

    if (cursor_ == index) {
        integrate(index);
        cursor_ = index + 1;
        public_ = record.standing;
        catching_up_ = false;
    } else {
        follow_old_track(record);
    }
}

// What leaves must have been integrated: the next record stands on it.
void Integrator::Engine::drop_oldest()
{
    if (cursor_ == 0) {
        integrate(0);
        cursor_ = 1;
    }
    const Record& oldest = history_.oldest();
    anchor_ = oldest.standing;
    carried_ = oldest.opinion;
    if (oldest.own_opinion) trust_.hear_old(oldest.opinion);
    history_.drop_oldest();
    history_dropped_ = true;
    --cursor_;
    if (window_end_ > 0) --window_end_;
    else window_size_ = 0;
}

// Nothing in the oldest `count` records can be corrected any more; what follows stands on this. The exclusions stay in force.
void Integrator::Engine::close_history(std::size_t count, const Standing& standing)
{
    for (; count > 0; --count) {
        carried_ = history_.oldest().opinion;
        if (history_.oldest().own_opinion) trust_.hear_old(history_.oldest().opinion);
        history_.drop_oldest();
    }
    history_dropped_ = false;
    cursor_ = window_end_ = window_size_ = 0;
    anchor_ = standing;
    integrated_again_ = 0;
    unpublished_ = std::min(unpublished_, history_.size());
    if (!history_.empty()) history_[0].standing.count = 0;
}

bool Integrator::Engine::reset(const Quaternion& attitude, std::uint64_t sequence)
{
    const std::size_t at = epoch_known_ ? history_.find(sequence) : history_.size();
    if (at == history_.size() || history_[at].last_sequence != sequence) return false;
    Standing standing;
    standing.attitude = attitude;
    standing.rate_rad_s = history_[at].standing.rate_rad_s;
    standing.variance = settings_.initial_sigma_rad * settings_.initial_sigma_rad;
    close_history(at + 1, standing);
    catching_up_ = !initialised_;
    initialised_ = true;
    seeded_ = seed_waits_ = false;
    if (history_.empty()) finish_correction();
    else work();
    return true;
}

void Integrator::Engine::take_over(const VotedAttitude& voted)
{
    taken_over_ = opinion_of(voted);
    unconfirmed_ = taken_over_.excluded;
    exclusions_known_ = exclusions_known_ || unconfirmed_ != 0;
    for (std::size_t i = 0; i < history_.size(); ++i)
        if (history_[i].own_opinion) unconfirmed_ &= ~history_[i].opinion.excluded;
    for (std::size_t i = 0; i < history_.size(); ++i)
        if (history_[i].own_opinion) history_[i].opinion.take_over(taken_over_, unconfirmed_);
    trust_.take_over(taken_over_, unconfirmed_);
    trust_.hear_old(taken_over_);
    carried_.known |= taken_over_.excluded;
}

void Integrator::Engine::begin_epoch(std::uint64_t epoch, const Quaternion& attitude)
{
    start_known_ = true;
    start_epoch_ = epoch;
    start_attitude_ = attitude;
}

void Integrator::Engine::seed(const VotedAttitude& voted)
{
    if (epoch_known_ && voted.epoch < epoch_) return;
    seed_waits_ = true;
    waiting_seed_ = voted;
    connect_seed();
    if (!caught_up()) work();
}

AxisMask Integrator::Engine::distrusted_in_seed() const
{
    if (!seeded_ || seed_frame_.epoch != epoch_) return 0;
    return trust_.excluded_at(seed_frame_.sequence) & ~taken_over_.excluded;
}

void Integrator::Engine::connect_seed()
{
    if (!seed_waits_) return;
    const VotedAttitude& voted = waiting_seed_;
    const bool no_frame_yet = !epoch_known_ || voted.epoch > epoch_;
    if (!no_frame_yet && voted.sequence >= next_sequence_) return;

    std::size_t after = 0;
    if (no_frame_yet) {
        epoch_ = voted.epoch;
        epoch_known_ = true;
        next_sequence_ = voted.sequence + 1;
        accumulated_known_ = false;
        history_.clear();
        trust_.begin_epoch(epoch_);
    } else {
        const std::size_t at = history_.find(voted.sequence);
        const bool just_before = at == history_.size() && !history_.empty() && history_.oldest().first_sequence == voted.sequence + 1 &&
                                 !(history_.oldest().bridge && history_.oldest().valid == 0);  // nobody knows what turned there
        const bool at_end = at < history_.size() && history_[at].last_sequence == voted.sequence;
        seed_waits_ = just_before || at_end;
        if (!seed_waits_) return;
        after = just_before ? 0 : at + 1;
    }
    close_history(after, standing_of(voted));
    take_over(voted);
    public_ = history_.empty() ? anchor_ : history_.newest().standing;
    reset_counter_ = voted.reset_counter;
    reset_rotation_ = from_array(voted.reset_rotation);
    seed_waits_ = false;
    seed_frame_ = identity_of(voted);
    seeded_ = initialised_ = catching_up_ = true;
    trust_.fold(history_);
    carry_opinion(0);
    refresh(0, history_.size());
}

}  // namespace quorient::attitude
