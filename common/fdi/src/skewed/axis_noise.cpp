#include "skewed/axis_noise.hpp"

#include "field/order.hpp"

#include <algorithm>

namespace quorient::fdi::skewed {
namespace {

constexpr double mean_memory_s = 0.3;

/// An axis may be so many times noisier than the others.
constexpr double own_cap = 6;

}  // namespace

AxisNoise::AxisNoise(std::size_t axes, double floor_rad_s, double interval_s)
    : count_(axes),
      floor_(floor_rad_s * floor_rad_s),
      rate_(field::TwoTermNoise::rates(interval_s)),
      mean_rate_(std::min(1.0, interval_s / mean_memory_s))
{
    reset();
}

void AxisNoise::reset()
{
    without_.fill(field::TwoTermNoise(floor_));
    along_.fill(field::TwoTermNoise(floor_));
    mean_.fill(0);
    others_.fill(floor_);
    own_.fill(floor_);
    typical_ = floor_;
}

void AxisNoise::reckon(const PerAxis& motion, const AxisParity& parity)
{
    double all = 0;
    for (std::size_t i = 0; i < count_; ++i)
        if (parity.set().has(i)) all += motion[i];
    const auto without = static_cast<double>(parity.set().size() - 1);
    PerAxis sorted{};
    std::size_t n = 0;
    for (std::size_t i = 0; i < count_; ++i) {
        if (!parity.set().has(i) || !parity.sees(i)) continue;
        const double share = parity.share(i, i);
        motion_without_[i] = (all - motion[i]) / without;
        motion_along_[i] = share * motion[i] + (1 - share) * motion_without_[i];
        others_[i] = without_[i].variance(motion_without_[i]);
        const double own = (along_[i].variance(motion_along_[i]) - (1 - share) * others_[i]) / share;
        own_[i] = std::clamp(own, others_[i], own_cap * own_cap * others_[i]);
        sorted[n++] = others_[i];
    }
    if (n > 0) typical_ = field::median(sorted.data(), n);
}

PerAxis AxisNoise::quick(const PerAxis& residual) const
{
    PerAxis quick{};
    for (std::size_t i = 0; i < count_; ++i) quick[i] = residual[i] - mean_[i];
    return quick;
}

void AxisNoise::learn(const AxisParity& parity, const PerAxis& quick, const PerAxis& clipped)
{
    const bool have_parity = parity.redundancy() > 1;
    for (std::size_t i = 0; i < count_; ++i) {
        if (!parity.set().has(i)) continue;
        mean_[i] += mean_rate_ * (clipped[i] - mean_[i]);
        if (!parity.sees(i)) continue;
        const auto [along, others] = parity.split(i, quick);
        along_[i].learn(along * along, motion_along_[i], rate_, floor_);
        without_[i].learn(have_parity ? others * others : along * along, motion_without_[i], rate_, floor_);
    }
}

}  // namespace quorient::fdi::skewed
