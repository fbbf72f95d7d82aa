#include "window_update.hpp"

#include "picard.hpp"

#include <algorithm>
#include <array>
#include <cmath>

namespace quorient::attitude {
namespace {

constexpr double equal_within = 1e-9;  // relative; what this leaves is below 1e-9 of the coning correction
constexpr double largest_noise_growth = 100;
constexpr std::size_t order_when_unresolved = 3;
constexpr double felt = 0.3;

bool all_equal(std::span<const Sample> samples)
{
    const double reference = samples.back().interval_s;
    return std::ranges::all_of(samples,
                               [reference](const Sample& s) { return std::abs(s.interval_s - reference) <= equal_within * reference; });
}

// How many samples are worth fitting: differences of the rate shrink with their order as long as the samples resolve the motion, and grow
// where they do not, or where noise is left. A sinusoid of frequency f gives |next| / |this| = 2 sin(pi f / fs) at every order, white noise
// sqrt(3) and more. Differences that have grown to a third of the first ones would be felt: the polynomial ends before them.
// Unequal intervals: divided differences of the angle at the samples' ends, in units of the mean interval (equal ones give the same).
std::size_t resolved_order(std::span<const Sample> samples, bool equal)
{
    std::array<Eigen::Vector3d, longest_memory + 1> value;
    std::array<double, longest_memory + 1> end_s{};
    value[0].setZero();
    for (std::size_t i = 0; i < samples.size(); ++i) {
        end_s[i + 1] = end_s[i] + samples[i].interval_s;
        value[i + 1] = value[i] + samples[i].increment;
    }
    const double mean_s = end_s[samples.size()] / static_cast<double>(samples.size());
    double first = 0;
    double before = 0;
    for (std::size_t order = 1; order <= samples.size(); ++order) {
        const std::size_t terms = samples.size() + 1 - order;
        double squares = 0;
        for (std::size_t i = 0; i < terms; ++i) {
            value[i] = value[i + 1] - value[i];
            if (!equal) value[i] *= static_cast<double>(order) * mean_s / (end_s[i + order] - end_s[i]);
            squares += value[i].squaredNorm();
        }
        const double mean = squares / static_cast<double>(terms);
        if (order == 2) first = mean;  // the increments' mean is the first difference of the rate
        if (order > 2 && mean > before && mean > felt * felt * first)
            return std::min(samples.size(), std::max(order - 1, order_when_unresolved));
        before = mean;
    }
    return samples.size();
}

}  // namespace

bool same_start(double earlier_interval_s, double interval_s)
{
    return earlier_interval_s <= 4 * interval_s;
}

Stretch::Stretch(std::span<const Sample> samples) : samples_(samples), equal_(all_equal(samples)), order_(resolved_order(samples, equal_))
{
}

std::size_t Stretch::begin_at(std::size_t target, std::size_t order) const
{
    const std::size_t newest_last = target + 1 >= order ? target + 1 - order : 0;
    return std::min(newest_last, samples_.size() - order);
}

std::size_t Stretch::order_at(std::size_t target) const
{
    if (equal_) return order_;
    for (std::size_t order = order_; order > 1; --order) {
        const auto fitted = samples_.subspan(begin_at(target, order), order);
        const double shortest = std::ranges::min(fitted, {}, &Sample::interval_s).interval_s;
        if (std::pow(samples_[target].interval_s / shortest, static_cast<double>(order - 1)) <= largest_noise_growth) return order;
    }
    return 1;
}

Quaternion Stretch::rotation(std::size_t target) const
{
    const std::size_t order = order_at(target);
    const std::size_t begin = begin_at(target, order);
    const auto fitted = samples_.subspan(begin, order);

    HalfRate rate;
    if (equal_) {
        rate = half_rate(equal_fit(order, target - begin), fitted);
    } else {
        std::array<double, longest_memory> interval{};
        std::ranges::transform(fitted, interval.begin(), &Sample::interval_s);
        rate = half_rate(fit_rate(std::span<const double>(interval).first(order), target - begin), fitted);
    }
    if (!(rate.largest_squared() <= largest_half_rate * largest_half_rate)) return from_rotation_vector(samples_[target].increment);
    return picard(rate);
}

Step WindowUpdate::step(std::uint64_t count, std::span<const Sample> recent) const
{
    if (count == 1) return {1, from_rotation_vector(recent.back().increment)};

    const Stretch stretch(recent);
    if (count > order_) return {1, stretch.rotation(recent.size() - 1)};

    Quaternion rotation = Quaternion::Identity();
    for (std::size_t i = 0; i < recent.size(); ++i) rotation = rotation * stretch.rotation(i);
    return {recent.size(), renormalised(rotation)};
}

}  // namespace quorient::attitude
