#include "field/learning.hpp"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>

namespace quorient::fdi::field {
namespace {

/// A residual beyond this many of its standard deviations is learned from as if it were so large.
constexpr double largest_step = 2.5;

double square(double x)
{
    return x * x;
}

}  // namespace

Learning::Learning(std::size_t instruments, const Allowed& allowed) : count_(instruments), allowed_(allowed)
{
    const ClassFigures& figures = allowed.figures;
    const double gain = square(figures.gain_floor);
    floor_ << square(figures.bias_floor_rad_s), gain, gain, gain, square(allowed.delay_floor_s);
    reset(false);
}

Covariance Learning::prior(bool rested) const
{
    const ClassFigures& figures = allowed_.figures;
    const double unknown = allowed_.calibrated ? figures.bias_calibrated_rad_s : figures.bias_unknown_rad_s;
    const double gain = square(allowed_.calibrated ? figures.gain_calibrated : figures.gain);
    Covariance covariance = Covariance::Zero();
    covariance.diagonal() << square(rested ? figures.bias_after_rest_rad_s : unknown), gain, gain, gain, square(allowed_.delay_s);
    return covariance;
}

void Learning::reset(bool rested)
{
    covariance_.fill(prior(rested));
    for (auto& component : learned_) component.fill(Parameters::Zero());
}

void Learning::admit(std::size_t m, bool rested)
{
    for (std::size_t c = 0; c < component_count; ++c) {
        learned_[c][m].setZero();
        covariance_[c] = prior(rested);
    }
}

void Learning::wander(double seconds)
{
    const double limit = square(allowed_.figures.bias_unknown_rad_s);
    for (Covariance& covariance : covariance_)
        covariance(bias, bias) =
            std::max(covariance(bias, bias), std::min(limit, covariance(bias, bias) + square(allowed_.figures.bias_wander_rad_s_root_s) * seconds));
}

double Learning::allowance(std::size_t component, const Parameters& regressors) const
{
    return regressors.dot(covariance_[component] * regressors) + floor_.dot(regressors.cwiseAbs2());
}

Parameters Learning::deviations() const
{
    Parameters largest = Parameters::Zero();
    for (const Covariance& covariance : covariance_) largest = largest.cwiseMax(Parameters((covariance.diagonal() + floor_).cwiseSqrt()));
    return largest;
}

void Learning::learn(std::size_t component, const Parameters& regressors, InstrumentSet present, const PerInstrument& residual,
                     double variance, double colour, double interval_s)
{
    Covariance& covariance = covariance_[component];
    const Parameters spread = covariance * regressors;
    const double known = regressors.dot(spread);
    const Parameters gain = spread / (known + colour * variance);
    const double limit = largest_step * std::sqrt(known + variance);
    PerInstrument step{};
    double mean = 0;
    for (std::size_t m = 0; m < count_; ++m) {
        if (!present.has(m)) continue;
        step[m] = std::clamp(residual[m], -limit, limit);
        mean += step[m] / static_cast<double>(present.size());
    }
    for (std::size_t m = 0; m < count_; ++m)
        if (present.has(m)) learned_[component][m] += gain * (step[m] - mean);
    covariance -= gain * spread.transpose();
    covariance(bias, bias) += square(allowed_.figures.bias_wander_rad_s_root_s) * interval_s;
    covariance = ((covariance + covariance.transpose()) / 2).eval();
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
