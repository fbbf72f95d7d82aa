#include "history.hpp"

#include "picture.hpp"

#include <algorithm>

namespace quorient::monitor {
namespace {

constexpr std::int64_t second_ns = 1'000'000'000;

}  // namespace

Sample sample_of(const Tick& tick, std::size_t lanes)
{
    Sample sample;
    sample.wall_time_ns = tick.wall_time_ns;
    sample.lanes = lanes;
    sample.axes = tick.described ? std::min<std::size_t>(tick.description.axis_count, max_axes) : 0;
    if (tick.voted_fresh) sample.sigma_rad = tick.voted.angle_sigma_rad;
    sample.error = tick.error;
    for (std::size_t place = 0; place < lanes; ++place) {
        sample.lane[place].residual = tick.lane[place].residual;
        sample.lane[place].bound = tick.lane[place].verdict.bound;
    }
    for (std::size_t axis = 0; axis < sample.axes; ++axis) sample.axis[axis] = state_in_system(tick, lanes, axis);
    return sample;
}

void Sample::add(const Sample& later)
{
    wall_time_ns = later.wall_time_ns;
    sigma_rad = later.sigma_rad;
    error.add(later.error);
    for (std::size_t place = 0; place < lanes; ++place) {
        for (std::size_t i = 0; i < axes; ++i) lane[place].residual[i].add(later.lane[place].residual[i]);
        lane[place].bound = later.lane[place].bound;
    }
    for (std::size_t i = 0; i < axes; ++i) axis[i] = std::max(axis[i], later.axis[i]);
}

void History::add(const Sample& sample)
{
    const bool same_second = second_.wall_time_ns / second_ns == sample.wall_time_ns / second_ns && second_.axes == sample.axes;
    if (same_second) return second_.add(sample);
    if (second_.wall_time_ns != 0) {
        auto text = dumped(sample_json(second_));
        const std::lock_guard lock{mutex_};
        seconds_.push_back(std::move(text));
        if (seconds_.size() > longest_s) seconds_.pop_front();
    }
    second_ = sample;
}

std::string History::text() const
{
    const std::lock_guard lock{mutex_};
    std::string all = "[";
    for (const auto& second : seconds_) {
        if (all.size() > 1) all += ',';
        all += second;
    }
    return all += ']';
}

}  // namespace quorient::monitor
