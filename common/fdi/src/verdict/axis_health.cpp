#include "verdict/axis_health.hpp"

#include "near_range.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>

namespace quorient::fdi {
namespace {

constexpr int absent_of_32 = 8;
constexpr std::uint32_t last_8 = 0xff;

constexpr double beyond_range = 1.02;
constexpr double others_range = 0.8;

constexpr unsigned least_repeats = 4;
constexpr double least_repeated_s = 0.03;
constexpr double moved_quanta = 5;
constexpr double moved_sigmas = 10;
constexpr double least_motion = 1e-7;  ///< rad/s; m/s^2: more than rounding
/// In the differences to the others. With such noise a sound axis of two instruments repeats a value four times in one of 1800 frames, and one of
/// four axes in one of 480 (Gaussian noise of 2.1 and 1.5 quanta).
constexpr double rarely_repeating_quanta = 3;

/// An increment is a rate times an interval: their quotient is the rate again up to rounding.
constexpr double quotient_rounding = 1e-12;

/// An axis's noise is known after this many frames that brought something new.
constexpr unsigned habit_frames = 50;
constexpr double habit_memory = 200;

}  // namespace

AxisHealth::AxisHealth(const geometry::SensorCluster& cluster) : cluster_(cluster), others_(cluster) {}

void AxisHealth::reset()
{
    broken_ = 0;
    absent_ = 0;
    missing_.fill(0);
    run_.fill({});
    habit_.fill({});
    fault_.fill(AxisFault::none);
}

AxisMask AxisHealth::assess(const Measurement& measurement, AxisMask isolated)
{
    if (!place_.follows(measurement.identity)) run_.fill({});
    place_ = StreamPlace::behind(measurement.identity);
    AxisMask here = 0;
    for (std::size_t axis = 0; axis < cluster_.size(); ++axis) {
        if (measurement.usable(axis)) here |= axis_bit(axis);
        count_absence(axis, has_axis(here, axis));
    }
    trusted_ = here & ~broken_ & ~isolated;  // what was just broken does not count against others
    if (measurement.interval_s > 0) others_.update(measurement, trusted_);
    broken_ = 0;
    for (std::size_t axis = 0; axis < cluster_.size(); ++axis) {
        fault_[axis] = AxisFault::none;
        if (!has_axis(here, axis) || !(measurement.interval_s > 0)) continue;
        follow(measurement, axis);
        fault_[axis] = judge(measurement, axis);
        if (fault_[axis] != AxisFault::none) broken_ |= axis_bit(axis);
    }
    return broken_;
}

void AxisHealth::count_absence(std::size_t axis, bool here)
{
    missing_[axis] = (missing_[axis] << 1) | (here ? 0U : 1U);
    if (std::popcount(missing_[axis]) >= absent_of_32) absent_ |= axis_bit(axis);
    if ((missing_[axis] & last_8) != 0) return;
    absent_ &= ~axis_bit(axis);
}

/// A run of equal values, or the next step.
void AxisHealth::follow(const Measurement& measurement, std::size_t axis)
{
    Run& run = run_[axis];
    const double rate = measurement.increment[axis] / measurement.interval_s;
    const bool same = run.known && std::abs(rate - run.rate) <= quotient_rounding * std::abs(rate) && !is_near_range(measurement, axis);
    if (same) return repeat(measurement, axis);
    learn(axis, rate);
    const OthersView::Range& others = others_.of(axis);
    run = {.rate = rate, .known = true, .lowest_high = others.high, .highest_low = others.low, .compared = others.known};
    for (std::size_t other = 0; other < cluster_.size(); ++other) run.begin[other] = measurement.increment[other] / measurement.interval_s;
}

void AxisHealth::repeat(const Measurement& measurement, std::size_t axis)
{
    Run& run = run_[axis];
    const OthersView::Range& others = others_.of(axis);
    ++run.repeats;
    run.seconds += measurement.interval_s;
    if (!others.known) return;
    run.independent = run.independent && others.independent;
    for (std::size_t other = 0; other < cluster_.size() && !run.independent; ++other) {
        const double motion = std::abs(measurement.increment[other] / measurement.interval_s - run.begin[other]);
        if (has_axis(trusted_, other) && motion > visible_motion(other)) run.moved |= axis_bit(other);
    }
    run.lowest_high = run.compared ? std::min(run.lowest_high, others.high) : others.high;
    run.highest_low = run.compared ? std::max(run.highest_low, others.low) : others.low;
    run.compared = true;
}

void AxisHealth::learn(std::size_t axis, double rate)
{
    Habit& habit = habit_[axis];
    const Run& run = run_[axis];
    const double step = std::abs(rate - run.rate);
    if (run.known && step > quotient_rounding * std::abs(rate) && (habit.quantum == 0 || step < habit.quantum)) habit.quantum = step;
    const OthersView::Range& others = others_.of(axis);
    if (!others.known) return;
    const double difference = rate - (others.low + others.high) / 2;
    if (run.known && run.repeats == 0) {
        const double change = difference - habit.last_difference;
        habit.frames = std::min(habit.frames + 1, 1U << 20);
        habit.variance += (change * change / 2 - habit.variance) / std::min<double>(habit.frames, habit_memory);
    }
    habit.last_difference = difference;
}

AxisFault AxisHealth::judge(const Measurement& measurement, std::size_t axis) const
{
    const double limit = cluster_.range(static_cast<Eigen::Index>(axis)) * measurement.interval_s;
    if (limit > 0 && std::abs(measurement.increment[axis]) > beyond_range * limit) return AxisFault::out_of_range;
    if (is_railed(measurement, axis)) return AxisFault::rail;
    if (!is_stuck(axis)) return AxisFault::none;
    return run_[axis].rate == 0 ? AxisFault::zero : AxisFault::stuck;
}

bool AxisHealth::is_stuck(std::size_t axis) const
{
    const Run& run = run_[axis];
    if (run.repeats < least_repeats || run.seconds < least_repeated_s || !run.compared) return false;
    if (!run.independent && (std::popcount(run.moved) < 2 || !rarely_repeats(axis))) return false;
    return run.highest_low - run.lowest_high > visible_motion(axis);
}

/// Noise that moves an axis over several of its steps lets no value stand.
bool AxisHealth::rarely_repeats(std::size_t axis) const
{
    const Habit& habit = habit_[axis];
    return habit.frames >= habit_frames && std::sqrt(habit.variance) >= rarely_repeating_quanta * quantum(axis);
}

/// [rad/s; m/s^2]
double AxisHealth::quantum(std::size_t axis) const
{
    const double stated = cluster_.interval_s > 0 ? cluster_.quantum(static_cast<Eigen::Index>(axis)) / cluster_.interval_s : 0;
    return stated > 0 ? stated : habit_[axis].quantum;
}

/// Infinite until the axis's noise is known.
double AxisHealth::visible_motion(std::size_t axis) const
{
    const Habit& habit = habit_[axis];
    const double stated_sigma = cluster_.sigma(static_cast<Eigen::Index>(axis)) / cluster_.interval_s;
    const bool known = cluster_.interval_s > 0 && (stated_sigma > 0 || habit.frames >= habit_frames);
    if (!known) return std::numeric_limits<double>::infinity();
    const double sigma = std::max(stated_sigma, habit.frames >= habit_frames ? std::sqrt(habit.variance) : 0);
    return std::max({moved_quanta * quantum(axis), moved_sigmas * sigma, least_motion});
}

bool AxisHealth::is_near_range(const Measurement& measurement, std::size_t axis) const
{
    return fdi::is_near_range(measurement.increment[axis], cluster_.range(static_cast<Eigen::Index>(axis)), measurement.interval_s);
}

bool AxisHealth::is_railed(const Measurement& measurement, std::size_t axis) const
{
    const OthersView::Range& others = others_.of(axis);
    const double least = others_range * cluster_.range(static_cast<Eigen::Index>(axis));
    return is_near_range(measurement, axis) && others.known && others.low > -least && others.high < least;
}

}  // namespace quorient::fdi
