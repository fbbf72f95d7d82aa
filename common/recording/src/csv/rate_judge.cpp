#include "rate_judge.hpp"

#include "readers.hpp"

#include <fmt/format.h>
#include <algorithm>
#include <cmath>

namespace quorient::recording::csv {
namespace {

constexpr std::size_t kept_values = 4096;
constexpr double beyond_rad_s = 70.0;    // 4000 deg/s, the widest range of a usual gyro
constexpr double beyond_deg_s = 4500.0;
constexpr std::size_t fewest_values = 200;
constexpr double step_tolerance = 0.002;  // a calibrated gain of a few percent is no usual step any more
constexpr double stretch_s = 0.25;
constexpr std::size_t fewest_stretches = 20;
constexpr double least_correlation = 0.7;
constexpr double gain_tolerance = 0.4;    // wide, since accelerations other than gravity disturb the comparison

/// Smallest steps of usual sensors [deg/s]: ranges of 125 to 4000 deg/s on 16 bits, and the rounder figures that some makers use.
constexpr std::array usual_steps_deg_s{125 / 32768.0, 250 / 32768.0, 500 / 32768.0, 1000 / 32768.0, 2000 / 32768.0, 4000 / 32768.0,
                                       1 / 131.0,     1 / 65.5,      1 / 32.8,      1 / 16.4,       1 / 8.2,        0.004375,
                                       0.00875,       0.0175,        0.035,         0.07,           0.14};

bool is_usual(double step_deg_s)
{
    return std::any_of(usual_steps_deg_s.begin(), usual_steps_deg_s.end(),
                       [&](double usual) { return std::abs(step_deg_s / usual - 1) < step_tolerance; });
}

std::array<double, 3> cross(const std::array<double, 3>& a, const std::array<double, 3>& b)
{
    return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}

double dot(const std::array<double, 3>& a, const std::array<double, 3>& b)
{
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

}  // namespace

std::optional<double> common_step(std::vector<double> values)
{
    std::sort(values.begin(), values.end());
    if (values.empty()) return std::nullopt;
    const double rounding = 1e-7 * std::max(std::abs(values.front()), std::abs(values.back()));
    std::vector<double> distinct;
    for (const double value : values)
        if (distinct.empty() || value - distinct.back() > rounding) distinct.push_back(value);
    constexpr std::size_t fewest_distinct = 5;
    if (distinct.size() < fewest_distinct) return std::nullopt;
    double step = distinct[1] - distinct[0];
    for (std::size_t i = 1; i < distinct.size(); ++i) step = std::min(step, distinct[i] - distinct[i - 1]);
    // From the middle outwards: each value makes the step more exact for the next, farther one.
    const double middle = distinct[distinct.size() / 2];
    std::sort(distinct.begin(), distinct.end(), [&](double a, double b) { return std::abs(a - middle) < std::abs(b - middle); });
    double products = step;
    double squares = 1;
    std::size_t fitting = 0;
    for (const double value : distinct) {
        const double distance = value - middle;
        const double count = std::round(distance / step);
        if (std::abs(distance - count * step) > 0.1 * step) continue;
        ++fitting;
        products += count * distance;
        squares += count * count;
        step = products / squares;
    }
    return fitting * 50 >= distinct.size() * 49 ? std::optional(step) : std::nullopt;
}

void RateJudge::add(double interval_s, const std::array<double, 3>& rate, const std::array<double, 3>& acceleration)
{
    bool gravity = interval_s > 0 && interval_s < stretch_s;
    for (std::size_t k = 0; k < 3; ++k) {
        if (!std::isfinite(rate[k])) return;
        gravity = gravity && std::isfinite(acceleration[k]);
        if (values_[k].size() < kept_values) values_[k].push_back(rate[k]);
        largest_ = std::max(largest_, std::abs(rate[k]));
        whole_numbers_ = whole_numbers_ && rate[k] == std::round(rate[k]);
    }
    ++samples_;
    if (!gravity) {
        current_ = {};
        before_.reset();
        return;
    }
    current_.duration_s += interval_s;
    ++current_.samples;
    for (std::size_t k = 0; k < 3; ++k) {
        current_.rate[k] += rate[k];
        current_.acceleration[k] += acceleration[k];
    }
    if (current_.duration_s < stretch_s) return;
    compare_with_gravity(current_);
    before_ = current_;
    current_ = {};
}

/// A direction that stands still in space moves in the body by -omega x it.
void RateJudge::compare_with_gravity(const Stretch& stretch)
{
    if (!before_) return;
    const auto direction = [](const Stretch& of) {
        const double length = std::sqrt(dot(of.acceleration, of.acceleration));
        return Vector{of.acceleration[0] / length, of.acceleration[1] / length, of.acceleration[2] / length};
    };
    const Vector first = direction(*before_);
    const Vector second = direction(stretch);
    Vector turn{};
    Vector middle{};
    Vector seen{};
    for (std::size_t k = 0; k < 3; ++k) {
        turn[k] = -0.5 * (before_->rate[k] / before_->samples * before_->duration_s + stretch.rate[k] / stretch.samples * stretch.duration_s);
        middle[k] = 0.5 * (first[k] + second[k]);
        seen[k] = second[k] - first[k];
    }
    const Vector expected = cross(turn, middle);
    if (!std::isfinite(dot(seen, seen)) || !std::isfinite(dot(expected, expected))) return;
    turn_squared_ += dot(expected, expected);
    seen_squared_ += dot(seen, seen);
    common_ += dot(seen, expected);
    ++stretches_;
}

bool RateJudge::looks_like_counts() const
{
    return whole_numbers_ && samples_ >= fewest_values && largest_ >= 2;
}

std::optional<RateJudge::Verdict> RateJudge::by_size() const
{
    if (largest_ > beyond_deg_s)
        return Verdict{std::nullopt, fmt::format("they reach {:.6g}, more than any gyro reads in deg/s: give --unit, or --lsb-per-deg-s for "
                                                 "raw counts",
                                                 largest_)};
    if (largest_ > beyond_rad_s)
        return Verdict{RateUnit::deg_s, fmt::format("they reach {:.6g}, and no gyro reads so many rad/s", largest_)};
    return std::nullopt;
}

std::optional<RateJudge::Verdict> RateJudge::by_step() const
{
    bool in_degrees = false;
    bool in_radians = false;
    double shown = 0;
    for (const auto& values : values_) {
        const auto step = values.size() < fewest_values ? std::nullopt : common_step(values);
        if (!step) continue;
        in_degrees = in_degrees || is_usual(*step);
        in_radians = in_radians || is_usual(*step / degree);
        if (is_usual(*step) || is_usual(*step / degree)) shown = *step;
    }
    if (in_degrees == in_radians) return std::nullopt;
    if (in_degrees) return Verdict{RateUnit::deg_s, fmt::format("their step of {:.6g} is that of a usual sensor in deg/s", shown)};
    return Verdict{RateUnit::rad_s, fmt::format("their step of {:.6g} rad/s is {:.4f} deg/s, that of a usual sensor", shown, shown / degree)};
}

std::optional<double> RateJudge::times_of_gravity() const
{
    if (stretches_ < fewest_stretches || !(turn_squared_ > 0) || !(seen_squared_ > 0)) return std::nullopt;
    if (common_ / std::sqrt(turn_squared_ * seen_squared_) < least_correlation) return std::nullopt;
    return common_ / turn_squared_;
}

std::optional<RateJudge::Verdict> RateJudge::by_gravity() const
{
    const auto gain = times_of_gravity();
    if (!gain) return std::nullopt;
    const auto says = [&](double unit) { return std::abs(*gain / unit - 1) < gain_tolerance; };
    if (says(1.0)) return Verdict{RateUnit::rad_s, fmt::format("gravity turns {:.2f} times as far as they say in rad/s", *gain)};
    if (says(degree)) return Verdict{RateUnit::deg_s, fmt::format("gravity turns {:.2f} times as far as they say in deg/s", *gain / degree)};
    return std::nullopt;
}

RateJudge::Verdict RateJudge::verdict() const
{
    if (looks_like_counts())
        return {std::nullopt,
                "they are whole numbers, as raw counts are: give --lsb-per-deg-s (16.4 is usual for a range of 2000 deg/s), or --unit"};
    if (const auto found = by_size()) return *found;
    if (const auto found = by_step()) return *found;
    if (const auto found = by_gravity()) return *found;
    return {std::nullopt, "they may be rad/s or deg/s: give --unit rad/s or --unit deg/s"};
}

}  // namespace quorient::recording::csv
