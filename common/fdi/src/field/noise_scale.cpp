#include "field/noise_scale.hpp"

#include "field/order.hpp"

#include <algorithm>

namespace quorient::fdi::field {
namespace {

constexpr std::array memory_s{0.3, 3.0};
constexpr double mean_memory_s = 0.3;
constexpr double fastest_rate = 0.5;

/// A square beyond this many variances counts as so many: outliers are not noise.
constexpr double largest_ratio = 9;

/// The mean of min(square / variance, largest_ratio) times this is 1.
constexpr double truncation = 1.05;

/// The least B; for arrays like the MIMU4444 it is about 1.
constexpr double least_moving = 0.25;

}  // namespace

NoiseScale::NoiseScale(std::size_t instruments, double floor_rad_s, double interval_s)
    : count_(instruments),
      floor_(floor_rad_s * floor_rad_s),
      rate_{std::min(fastest_rate, interval_s / memory_s[0]), std::min(fastest_rate, interval_s / memory_s[1])},
      mean_rate_(std::min(1.0, interval_s / mean_memory_s))
{
    reset();
}

void NoiseScale::reset()
{
    const Term initial{.standing = floor_, .moving = 1};
    for (std::size_t c = 0; c < component_count; ++c) {
        pairs_[c].fill({.term = {initial, initial}, .variance = floor_});
        mean_[c].fill(0);
        others_[c].fill(floor_);
        own_[c].fill(floor_);
        typical_[c] = floor_;
    }
}

void NoiseScale::reckon(std::size_t component, double motion, InstrumentSet compared)
{
    motion_[component] = motion;
    for (std::size_t i = 0; i < count_; ++i)
        for (std::size_t j = i + 1; j < count_; ++j) {
            Pair& p = pair(component, i, j);
            p.variance = std::max(p.term[0].standing + p.term[0].moving * motion, p.term[1].standing + p.term[1].moving * motion);
        }
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

/// The median over the pairs of compared instruments; the floor where there are none.
double NoiseScale::median_without(std::size_t component, InstrumentSet compared, std::size_t left_out) const
{
    std::array<double, max_instruments * max_instruments / 2> variances;
    std::size_t n = 0;
    for (std::size_t i = 0; i < count_; ++i) {
        if (i == left_out || !compared.has(i)) continue;
        for (std::size_t j = i + 1; j < count_; ++j)
            if (j != left_out && compared.has(j)) variances[n++] = pair(component, i, j).variance;
    }
    if (n == 0) return floor_;
    std::nth_element(variances.begin(), variances.begin() + n / 2, variances.begin() + n);
    return variances[n / 2];
}

bool NoiseScale::is_within(double standing, double moving, InstrumentSet compared) const
{
    for (std::size_t c = 0; c < component_count; ++c)
        for (std::size_t i = 0; i < count_; ++i)
            for (std::size_t j = i + 1; j < count_; ++j) {
                if (!compared.has(i) || !compared.has(j)) continue;
                const Term& slow = pair(c, i, j).term.back();
                if (slow.standing > std::max(standing, floor_) || slow.moving > std::max(moving, least_moving)) return false;
            }
    return true;
}

void NoiseScale::learn(Pair& pair, double half_square, double motion) const
{
    for (std::size_t speed = 0; speed < pair.term.size(); ++speed) {
        Term& term = pair.term[speed];
        const double variance = term.standing + term.moving * motion;
        const double excess = truncation * std::min(largest_ratio, half_square / variance) - 1;
        const double share = term.standing / variance;
        term.standing = std::max(floor_, term.standing * (1 + rate_[speed] * share * excess));
        term.moving = std::max(least_moving, term.moving * (1 + rate_[speed] * (1 - share) * excess));
    }
}

void NoiseScale::learn(std::size_t component, InstrumentSet present, const PerInstrument& quick, const PerInstrument& clipped)
{
    for (std::size_t i = 0; i < count_; ++i) {
        if (!present.has(i)) continue;
        mean_[component][i] += mean_rate_ * (clipped[i] - mean_[component][i]);
        for (std::size_t j = i + 1; j < count_; ++j) {
            if (!present.has(j)) continue;
            const double difference = quick[i] - quick[j];
            learn(pair(component, i, j), difference * difference / 2, motion_[component]);
        }
    }
}

}  // namespace quorient::fdi::field
