#include "rest_learner.hpp"

#include "quorient/fdi/sensor_class.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>

namespace quorient::sensor {
namespace {

constexpr double block_length_s = 0.5;
constexpr double quiet_rad_s = 0.02;
constexpr double slow_rad_s = 0.05;
constexpr double steady_rad_s = 0.02;

double median(std::array<double, max_axes>& values, std::size_t count)
{
    const auto middle = values.begin() + static_cast<std::ptrdiff_t>(count / 2);
    std::nth_element(values.begin(), middle, values.begin() + static_cast<std::ptrdiff_t>(count));
    return *middle;
}

}  // namespace

void RestLearner::Figures::add(double value)
{
    ++count;
    const double before = value - mean;
    mean += before / static_cast<double>(count);
    squares += before * (value - mean);
}

double RestLearner::Figures::deviation() const
{
    return count > 1 ? std::sqrt(squares / static_cast<double>(count - 1)) : 0;
}

RestLearner::RestLearner(std::vector<std::size_t> instrument, double rest_s)
    : instrument_(std::move(instrument)), rest_s_(rest_s), state_(rest_s > 0 ? State::learning : State::moving)
{
    assert(instrument_.size() <= max_axes);
    for (const std::size_t place : instrument_) instruments_ = std::max(instruments_, place + 1);
}

void RestLearner::add(const SensorFrame& raw)
{
    for (std::size_t axis = 0; axis < instrument_.size(); ++axis)
        if (has_axis(raw.valid_mask, axis)) block_[axis].add(raw.increment[axis] / raw.interval_s);
    interval_s_ = raw.interval_s;
    block_s_ += raw.interval_s;
    ++frames_;
    if (block_s_ >= block_length_s) end_block();
}

/// The median over the instruments with data in the block of the largest figure of their axes.
template <class Figure>
double RestLearner::median_of_instruments(Figure figure) const
{
    std::array<double, max_axes> largest{};
    std::size_t count = 0;
    for (std::size_t m = 0; m < instruments_; ++m) {
        double value = -1;
        for (std::size_t axis = 0; axis < instrument_.size(); ++axis)
            if (instrument_[axis] == m && block_[axis].count > 0) value = std::max(value, figure(axis));
        if (value >= 0) largest[count++] = value;
    }
    return count > 0 ? median(largest, count) : 0;
}

bool RestLearner::block_rests() const
{
    return median_of_instruments([this](std::size_t axis) { return block_[axis].deviation(); }) < quiet_rad_s &&
           median_of_instruments([this](std::size_t axis) { return std::abs(block_[axis].mean); }) < slow_rad_s &&
           median_of_instruments([this](std::size_t axis) {
               return axes_[axis].count > 0 ? std::abs(block_[axis].mean - axes_[axis].mean) : 0.0;
           }) < steady_rad_s;
}

void RestLearner::end_block()
{
    if (!block_rests()) {
        state_ = State::moving;
        return;
    }
    for (std::size_t axis = 0; axis < instrument_.size(); ++axis) {
        // Two sets of figures as one [Chan, Golub & LeVeque 1983].
        Figures& all = axes_[axis];
        const Figures& block = block_[axis];
        if (block.count == 0) continue;
        const double apart = block.mean - all.mean;
        const auto count = static_cast<double>(all.count + block.count);
        all.squares += block.squares + apart * apart * static_cast<double>(all.count) * static_cast<double>(block.count) / count;
        all.mean += apart * static_cast<double>(block.count) / count;
        all.count += block.count;
    }
    rested_s_ += block_s_;
    block_ = {};
    block_s_ = 0;
    if (rested_s_ >= rest_s_) conclude();
}

void RestLearner::conclude()
{
    state_ = State::rested;
    const double largest_rad_s = fdi::figures_of(fdi::SensorClass::consumer).largest_bias_rad_s;
    for (std::size_t axis = 0; axis < instrument_.size(); ++axis)
        if (2 * axes_[axis].count > frames_ && std::abs(axes_[axis].mean) <= largest_rad_s) learned_ |= axis_bit(axis);
}

double RestLearner::sigma_rad(std::size_t axis) const
{
    return axes_[axis].deviation() * interval_s_;
}

}  // namespace quorient::sensor
