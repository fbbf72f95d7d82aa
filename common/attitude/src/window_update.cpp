#include "window_update.hpp"

#include "picard.hpp"

#include <algorithm>
#include <cmath>

namespace quorient::attitude {
namespace {

constexpr double equal_within = 1e-9;  // relative; what this leaves is below 1e-9 of the coning correction
constexpr double largest_noise_growth = 100;
constexpr std::size_t order_when_unresolved = 3;

bool all_equal(std::span<const Sample> samples)
{
    const double reference = samples.back().interval_s;
    return std::ranges::all_of(samples,
                               [reference](const Sample& s) { return std::abs(s.interval_s - reference) <= equal_within * reference; });
}

// Whether differences of the rate shrink with their order, as they do for what the samples resolve. A sinusoid of frequency f
// gives |second| / |first| = 2 sin(pi f / fs), white noise sqrt(3).
bool resolved(std::span<const Sample> samples, bool equal)
{
    if (samples.size() <= order_when_unresolved) return true;
    const auto rate = [&](std::size_t i) -> Eigen::Vector3d {
        return equal ? samples[i].increment : samples[i].increment / samples[i].interval_s;
    };
    double first = 0;
    double second = 0;
    Eigen::Vector3d at = rate(0);
    Eigen::Vector3d before = Eigen::Vector3d::Zero();
    for (std::size_t i = 1; i < samples.size(); ++i) {
        const Eigen::Vector3d next = rate(i);
        const Eigen::Vector3d difference = next - at;
        first += difference.squaredNorm();
        if (i > 1) second += (difference - before).squaredNorm();
        before = difference;
        at = next;
    }
    const auto terms = static_cast<double>(samples.size() - 1);
    return second * terms <= first * (terms - 1);
}

}  // namespace

bool same_start(double earlier_interval_s, double interval_s)
{
    return earlier_interval_s <= 4 * interval_s;
}

Stretch::Stretch(std::span<const Sample> samples)
    : samples_(samples), equal_(all_equal(samples)), order_(resolved(samples, equal_) ? samples.size() : order_when_unresolved)
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
