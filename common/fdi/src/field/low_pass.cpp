#include "field/low_pass.hpp"

#include "field/dead_zone.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace quorient::fdi::field {
namespace {

constexpr double corner_hz = 2;
constexpr double vibration_memory_s = 0.3;
constexpr double corner_rad_s = 2 * std::numbers::pi * corner_hz;

/// The least that counts as slow motion [rad/s, rad/s^2].
constexpr double least_rate = 0.1 * std::numbers::pi / 180;
constexpr double least_acceleration = 0.1 * std::numbers::pi / 180;

}  // namespace

SlowPart::SlowPart(double interval_s)
    : interval_s_(interval_s), rate_(1 - std::exp(-corner_rad_s * interval_s)), colour_(1 / (corner_rad_s * interval_s))
{
    reset();
}

void SlowPart::reset()
{
    begun_.fill({});
    moving_.fill(false);
    vibration_.fill(0);
    regressors_.fill(Parameters::Zero());
    for (auto& component : slow_) component.fill(0);
    for (LowPass& motion : motion_) motion.begin_at(0);
}

void SlowPart::add(std::size_t component, const Input& input, InstrumentSet compared, const PerInstrument& deviations)
{
    const auto c = static_cast<Eigen::Index>(component);
    Parameters motion;
    motion << 1, input.rate, input.acceleration;
    for (std::size_t p = 0; p < parameter_count; ++p) {
        LowPass& filter = regressor_[component][p];
        if (!moving_[component]) filter.begin_at(motion(static_cast<Eigen::Index>(p)));
        regressors_[component](static_cast<Eigen::Index>(p)) = filter.follow(motion(static_cast<Eigen::Index>(p)), rate_);
    }
    moving_[component] = true;
    const double passed = std::sqrt(std::min(1.0, rate_ / 4));  // the share of white noise that passes
    Parameters& slow = regressors_[component];
    slow(bias) = 1;
    for (Eigen::Index k = 0; k < 3; ++k)
        slow(gain_x + k) = dead_zone(slow(gain_x + k), std::max(rate_dead_zone * input.rate_noise(k) * passed, least_rate));
    const double noise = acceleration_dead_zone * input.noise * passed * corner_rad_s;
    slow(delay) = dead_zone(slow(delay), std::max(noise, least_acceleration));

    for (std::size_t m = 0; m < max_instruments; ++m) {
        if (!compared.has(m)) continue;
        LowPass& filter = deviation_[component][m];
        if (!begun_[component].has(m)) filter.begin_at(deviations[m]);
        slow_[component][m] = filter.follow(deviations[m], rate_);
    }
    begun_[component] = compared;

    const double quick = input.rate(c) - motion_[component].follow(input.rate(c), rate_);
    vibration_[component] += std::min(1.0, interval_s_ / vibration_memory_s) * (quick * quick - vibration_[component]);
}

}  // namespace quorient::fdi::field
