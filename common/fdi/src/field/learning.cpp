#include "field/learning.hpp"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>

namespace quorient::fdi::field {
namespace {

/// Sound sensors of different make sample up to some milliseconds apart.
constexpr double delay_of_interval = 0.1;
constexpr double least_delay_s = 1.0e-3;

/// What of the delay may change without being learned.
constexpr double unlearned_delay = 0.5;

double square(double x)
{
    return x * x;
}

}  // namespace

Allowed allowed_by(const DetectorSettings& settings, double frame_interval_s)
{
    const double delay_s = settings.delay_class_s.value_or(std::max(least_delay_s, delay_of_interval * frame_interval_s));
    return {.figures = figures_of(settings.sensor_class),
            .calibrated = settings.calibrated,
            .delay_s = delay_s,
            .delay_floor_s = unlearned_delay * delay_s};
}

Learning::Learning(std::size_t instruments, const Allowed& allowed) : count_(instruments), allowed_(allowed)
{
    const ClassFigures& figures = allowed.figures;
    const double gain = square(figures.gain_floor);
    floor_ << square(figures.bias_floor_rad_s), gain, gain, gain, square(allowed.delay_floor_s);
    reset(false);
}

Parameters Learning::prior(bool rested) const
{
    const double gain = square(allowed_.gain());
    Parameters variances;
    variances << square(allowed_.bias(rested)), gain, gain, gain, square(allowed_.delay_s);
    return variances;
}

void Learning::reset(bool rested)
{
    for (auto& allowance : allowance_) allowance.begin(prior(rested), floor_);
    for (auto& component : learned_) component.fill(Parameters::Zero());
}

void Learning::admit(std::size_t m, bool rested)
{
    for (std::size_t c = 0; c < component_count; ++c) {
        learned_[c][m].setZero();
        allowance_[c].begin(prior(rested), floor_);
    }
}

void Learning::wander(double seconds)
{
    for (auto& allowance : allowance_) wander_within(allowance, allowed_, seconds);
}

Parameters Learning::deviations() const
{
    Parameters largest = Parameters::Zero();
    for (const auto& allowance : allowance_) largest = largest.cwiseMax(allowance.deviations());
    return largest;
}

void Learning::learn(std::size_t component, const Parameters& regressors, InstrumentSet present, const PerInstrument& residual,
                     double variance, double colour, double interval_s)
{
    const auto [gain, limit] = allowance_[component].learn(regressors, variance, colour);
    PerInstrument step{};
    double mean = 0;
    for (std::size_t m = 0; m < count_; ++m) {
        if (!present.has(m)) continue;
        step[m] = std::clamp(residual[m], -limit, limit);
        mean += step[m] / static_cast<double>(present.size());
    }
    for (std::size_t m = 0; m < count_; ++m)
        if (present.has(m)) learned_[component][m] += gain * (step[m] - mean);
    allowance_[component].add_variance(bias, square(allowed_.figures.bias_wander_rad_s_root_s) * interval_s);
}

void Learning::centre(InstrumentSet compared)
{
    if (compared.empty()) return;
    for (auto& component : learned_) {
        Parameters mean = Parameters::Zero();
        for (std::size_t m = 0; m < count_; ++m)
            if (compared.has(m)) mean += component[m] / static_cast<double>(compared.size());
        for (std::size_t m = 0; m < count_; ++m)
            if (compared.has(m)) component[m] -= mean;
    }
}

}  // namespace quorient::fdi::field
