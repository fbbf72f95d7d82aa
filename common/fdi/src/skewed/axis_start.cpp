#include "skewed/axis_start.hpp"

#include "field/order.hpp"
#include "field/windows.hpp"

namespace quorient::fdi::skewed {

AxisStart::AxisStart(const geometry::Axes& axes, double interval_s, const ClassFigures& figures)
    : axes_(axes),
      count_(static_cast<std::size_t>(axes.rows())),
      frames_needed_(field::FirstSecond::frames_needed(interval_s)),
      recent_rate_(std::min(1.0, interval_s / field::FirstSecond::recent_s)),
      figures_(figures)
{
}

void AxisStart::reset()
{
    for (std::size_t i = 0; i < count_; ++i) forget(i);
    outside_class_.reset();
}

void AxisStart::forget(std::size_t axis)
{
    first_[axis] = {};
    recent_[axis] = 0;
    bias_[axis] = 0;
    started_.remove(axis);
    rested_.remove(axis);
}

void AxisStart::distrust(std::size_t axis)
{
    bias_[axis] = 0;
    rested_.remove(axis);
}

AxisSet AxisStart::add(const AxisFrame& frame)
{
    AxisSet ended;
    for (std::size_t i = 0; i < count_; ++i) {
        if (!frame.present.has(i)) continue;
        if (started_.has(i)) {
            recent_[i] += recent_rate_ * (frame.rate[i] - bias_[i] - recent_[i]);
            continue;
        }
        first_[i].add(frame.rate[i]);
        if (first_[i].frames() >= frames_needed_) ended.add(i);
    }
    if (ended.empty()) return ended;

    outside_class_.reset();
    const bool rest = is_rest(ended);
    if (rest) check_class(ended);
    for (std::size_t i = 0; i < count_; ++i) {
        if (!ended.has(i)) continue;
        if (rest) bias_[i] = first_[i].mean();
        recent_[i] = first_[i].mean() - bias_[i];
        rested_.set(i, rest);
    }
    started_ = started_ | ended;
    return ended;
}

bool AxisStart::is_rest(AxisSet ended) const
{
    PerAxis levels{};
    std::size_t n = 0;
    for (std::size_t i = 0; i < count_; ++i) {
        if (ended.has(i) && first_[i].deviation() > field::FirstSecond::largest_deviation_at_rest) return false;
        if ((ended | started_).has(i)) levels[n++] = std::abs(level(i, ended));
    }
    return field::median(levels.data(), n) <= field::FirstSecond::largest_rate_at_rest;
}

void AxisStart::check_class(AxisSet ended)
{
    const AxisParity parity(axes_, ended | started_);
    if (parity.redundancy() < 2) return;
    PerAxis levels{};
    for (std::size_t i = 0; i < count_; ++i)
        if (parity.set().has(i)) levels[i] = level(i, ended);
    const PerAxis residual = parity.residual(levels);
    const double limit = std::sqrt(of_three) * figures_.largest_bias_rad_s;
    double largest = limit;
    double second = 0;
    for (std::size_t i = 0; i < count_; ++i) {
        if (!parity.set().has(i) || !parity.sees(i)) continue;
        const auto [along, others] = parity.split(i, residual);
        const double beyond = std::abs(along) - field::Windows::scatter_factor(parity.redundancy() - 1) * std::sqrt(parity.share(i, i)) * others;
        if (beyond <= largest) {
            second = std::max(second, beyond);
            continue;
        }
        if (outside_class_) second = std::max(second, largest);
        largest = beyond;
        outside_class_ = i;
    }
    if (!outside_class_ || largest < field::Windows::margin * second || !ended.has(*outside_class_)) outside_class_.reset();
}

}  // namespace quorient::fdi::skewed
