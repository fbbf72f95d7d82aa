#include "field/noise_scale.hpp"

#include "field/order.hpp"

#include <algorithm>

namespace quorient::fdi::field {
namespace {

constexpr double mean_memory_s = 0.3;

}  // namespace

NoiseScale::NoiseScale(std::size_t instruments, double floor_rad_s, double interval_s)
    : count_(instruments),
      floor_(floor_rad_s * floor_rad_s),
      rate_(TwoTermNoise::rates(interval_s)),
      mean_rate_(std::min(1.0, interval_s / mean_memory_s))
{
    reset();
}

void NoiseScale::reset()
{
    for (std::size_t c = 0; c < component_count; ++c) {
        pairs_[c].fill({.noise = TwoTermNoise(floor_), .variance = floor_});
        mean_[c].fill(0);
        others_[c].fill(floor_);
        own_[c].fill(floor_);
        typical_[c] = floor_;
        std::size_t n = 0;
        for (std::size_t i = 0; i < count_; ++i)
            for (std::size_t j = i + 1; j < count_; ++j) ranked_[c][n++] = {floor_, static_cast<std::uint8_t>(i), static_cast<std::uint8_t>(j)};
    }
}

void NoiseScale::reckon(std::size_t component, double motion, InstrumentSet compared)
{
    motion_[component] = motion;
    rank(component, motion);
    typical_[component] = median_without(component, compared, nobody);
    for (std::size_t m = 0; m < count_; ++m) {
        if (!compared.has(m)) continue;
        const double others = leave_one_out ? median_without(component, compared, m) : typical_[component];
        PerInstrument with{};
        std::size_t n = 0;
        for (std::size_t j = 0; j < count_; ++j)
            if (j != m && compared.has(j)) with[n++] = pair(component, std::min(m, j), std::max(m, j)).variance;
        sort(with.data(), n);
        const double own = n == 0 ? others : std::max(others, 2 * with[(n - 1) / 2] - others);
        others_[component][m] = others;
        own_[component][m] = std::min(own, own_cap * own_cap * others);
    }
}

void NoiseScale::rank(std::size_t component, double motion)
{
    auto& ranked = ranked_[component];
    const std::size_t pairs = count_ * (count_ - 1) / 2;
    for (std::size_t n = 0; n < pairs; ++n) {
        Ranked& one = ranked[n];
        Pair& p = pair(component, one.i, one.j);
        one.variance = p.variance = p.noise.variance(motion);
    }
    for (std::size_t n = 1; n < pairs; ++n) {
        const Ranked one = ranked[n];
        std::size_t place = n;
        for (; place > 0 && ranked[place - 1].variance > one.variance; --place) ranked[place] = ranked[place - 1];
        ranked[place] = one;
    }
}

/// The median over the pairs of compared instruments; the floor where there are none.
double NoiseScale::median_without(std::size_t component, InstrumentSet compared, std::size_t left_out) const
{
    if (left_out != nobody) compared.remove(left_out);
    const std::size_t members = compared.size();
    std::size_t below = members * (members - 1) / 2 / 2;
    if (members < 2) return floor_;
    for (const Ranked& one : ranked_[component])
        if (compared.has(one.i) && compared.has(one.j) && below-- == 0) return one.variance;
    return floor_;
}

bool NoiseScale::is_within(double standing, double moving, InstrumentSet compared) const
{
    for (std::size_t c = 0; c < component_count; ++c)
        for (std::size_t i = 0; i < count_; ++i)
            for (std::size_t j = i + 1; j < count_; ++j) {
                if (!compared.has(i) || !compared.has(j)) continue;
                const TwoTermNoise::Term& slow = pair(c, i, j).noise.slow();
                if (slow.standing > std::max(standing, floor_) || slow.moving > std::max(moving, TwoTermNoise::least_moving)) return false;
            }
    return true;
}

void NoiseScale::learn(std::size_t component, InstrumentSet present, const PerInstrument& quick, const PerInstrument& clipped)
{
    for (std::size_t i = 0; i < count_; ++i) {
        if (!present.has(i)) continue;
        mean_[component][i] += mean_rate_ * (clipped[i] - mean_[component][i]);
        for (std::size_t j = i + 1; j < count_; ++j) {
            if (!present.has(j)) continue;
            const double difference = quick[i] - quick[j];
            pair(component, i, j).noise.learn(difference * difference / 2, motion_[component], rate_, floor_);
        }
    }
}

}  // namespace quorient::fdi::field
