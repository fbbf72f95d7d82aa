#include "counter_noise.hpp"
#include "quorient/simulation/faults.hpp"

#include <fmt/format.h>
#include <bit>
#include <cassert>
#include <cmath>

namespace quorient::simulation {
namespace {

constexpr double no_sample = std::numeric_limits<double>::quiet_NaN();

bool same_bits(double a, double b)
{
    return std::bit_cast<std::uint64_t>(a) == std::bit_cast<std::uint64_t>(b);
}

/// The integral of value * sin(2 pi f (t - start)) over the interval around `middle`.
double oscillation(const FaultSpec& fault, double middle_s, double interval_s)
{
    const double frequency_rad_s = 2.0 * std::numbers::pi * fault.frequency_hz;
    const double swept = 2.0 / frequency_rad_s * std::sin(frequency_rad_s * interval_s / 2.0);
    return fault.value * swept * std::sin(frequency_rad_s * (middle_s - fault.start_s));
}

/// One frame per period: the one whose middle is the first after start + k periods.
bool spikes(const FaultSpec& fault, double middle_s, double interval_s)
{
    return std::fmod(middle_s - fault.start_s, fault.period_s) < interval_s;
}

bool acts(const FaultSpec& fault, double middle_s)
{
    return middle_s >= fault.start_s && middle_s < fault.end_s;
}

void lose(std::size_t axis, SensorFrame& frame)
{
    frame.increment[axis] = 0;
    frame.valid_mask &= ~axis_bit(axis);
}

}  // namespace

FaultInjector::FaultInjector(geometry::SensorCluster cluster, std::uint64_t seed)
    : cluster_(std::move(cluster)), seed_(seed), history_(delay_history_frames)
{
    faults_.reserve(capacity);
}

tl::expected<void, std::string> FaultInjector::add(const FaultSpec& fault)
{
    auto resolved = resolve(fault, cluster_);
    if (!resolved) return tl::unexpected(std::move(resolved.error()));
    std::erase_if(faults_, [this](const Active& active) { return active.fault.end_s <= newest_s_; });
    if (faults_.size() == capacity) return tl::unexpected(fmt::format("{} faults are in place already; clear some first", capacity));
    faults_.push_back({std::move(*resolved), 0, {}});
    return {};
}

void FaultInjector::clear(AxisMask axes)
{
    for (Active& active : faults_) active.fault.axes &= ~axes;
    std::erase_if(faults_, [](const Active& active) { return active.fault.axes == 0; });
}

AxisMask FaultInjector::apply(SensorFrame& frame, double begin_s)
{
    assert(frame.axis_count == cluster_.size());
    remember(frame);
    const auto measured = frame.increment;
    const AxisMask measured_valid = frame.valid_mask;

    const double middle_s = newest_s_ = begin_s + frame.interval_s / 2.0;
    for (Active& active : faults_) {
        if (!acts(active.fault, middle_s)) continue;
        for (std::size_t axis = 0; axis < frame.axis_count; ++axis)
            if (has_axis(active.fault.axes, axis)) apply(active, axis, frame, begin_s);
    }

    AxisMask touched = frame.valid_mask ^ measured_valid;
    for (std::size_t axis = 0; axis < frame.axis_count; ++axis) {
        if (!same_bits(frame.increment[axis], measured[axis])) touched |= axis_bit(axis);
        if (!has_axis(frame.valid_mask, axis) || !std::isfinite(frame.increment[axis])) continue;
        last_value_[axis] = frame.increment[axis];
        has_last_value_ |= axis_bit(axis);
    }
    return touched;
}

void FaultInjector::apply(Active& active, std::size_t axis, SensorFrame& frame, double begin_s)
{
    const FaultSpec& fault = active.fault;
    const double interval_s = frame.interval_s;
    const double middle_s = begin_s + interval_s / 2.0;
    const auto row = static_cast<Eigen::Index>(axis);
    double& increment = frame.increment[axis];

    const bool onset = !has_axis(active.captured, axis);
    active.captured |= axis_bit(axis);

    switch (fault.kind) {
        case FaultKind::unknown:
            break;
        case FaultKind::bias:
            increment += fault.value * interval_s;
            break;
        case FaultKind::ramp:
            increment += fault.value * (middle_s - fault.start_s) * interval_s;
            break;
        case FaultKind::scale:
            increment *= fault.value;
            break;
        case FaultKind::stuck:
            if (onset) active.held[axis] = has_axis(has_last_value_, axis) ? last_value_[axis] : increment;
            increment = active.held[axis];
            break;
        case FaultKind::zero:
            increment = 0;
            break;
        case FaultKind::rail:
            if (onset) active.held[axis] = std::copysign(cluster_.range(row), increment);
            increment = active.held[axis] * interval_s;
            break;
        case FaultKind::sign:
            increment = -increment;
            break;
        case FaultKind::nan:
            increment = std::numeric_limits<double>::quiet_NaN();
            break;
        case FaultKind::noise:
            increment += fault.value * cluster_.sigma(row) * gaussian(mixed(seed_), axis, frame.sequence);
            break;
        case FaultKind::oscillation:
            increment += oscillation(fault, middle_s, interval_s);
            break;
        case FaultKind::dropout:  // one draw per fault and frame: the axes of an instrument fall silent together
            if (uniform(mixed(seed_ + 1), static_cast<std::uint64_t>(std::countr_zero(fault.axes)), frame.sequence) < fault.value)
                lose(axis, frame);
            break;
        case FaultKind::delay:
            delay(fault.value, axis, frame);
            break;
        case FaultKind::spike:
            if (spikes(fault, middle_s, interval_s)) increment += fault.value * interval_s;
            break;
    }
}

/// The rate is taken as constant within each past interval, so a delay between two frames is a weighted mean of two increments.
void FaultInjector::delay(double delay_s, std::size_t axis, SensorFrame& frame) const
{
    const double intervals = delay_s / frame.interval_s;
    const auto whole = static_cast<std::uint64_t>(intervals);
    if (history_count_ < whole + 2 || whole + 2 > delay_history_frames) return lose(axis, frame);

    const auto past = [&](std::uint64_t frames_ago) { return history_[(history_count_ - 1 - frames_ago) % delay_history_frames][axis]; };
    const double fraction = intervals - static_cast<double>(whole);
    const double increment = fraction == 0.0 ? past(whole) : (1.0 - fraction) * past(whole) + fraction * past(whole + 1);
    if (!std::isfinite(increment)) return lose(axis, frame);
    frame.increment[axis] = increment;
    frame.valid_mask |= axis_bit(axis);
}

void FaultInjector::remember(const SensorFrame& frame)
{
    auto& place = history_[history_count_++ % delay_history_frames];
    for (std::size_t axis = 0; axis < frame.axis_count; ++axis)
        place[axis] = has_axis(frame.valid_mask, axis) ? frame.increment[axis] : no_sample;
}

AxisMask FaultInjector::active_axes(double time_s) const
{
    AxisMask axes = 0;
    for (const Active& active : faults_)
        if (acts(active.fault, time_s)) axes |= active.fault.axes;
    return axes;
}

void FrameAccumulator::add(SensorFrame& frame)
{
    for (std::size_t axis = 0; axis < frame.axis_count; ++axis) {
        if (has_axis(frame.valid_mask, axis) && std::isfinite(frame.increment[axis])) accumulated_[axis] += frame.increment[axis];
        else ++missed_[axis];
    }
    frame.accumulated = accumulated_;
    frame.missed = missed_;
}

void FrameAccumulator::skip(std::uint32_t frames)
{
    for (std::uint32_t& missed : missed_) missed += frames;
}

}  // namespace quorient::simulation
