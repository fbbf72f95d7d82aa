#include "skewed/axis_comparison.hpp"

#include "field/dead_zone.hpp"
#include "field/frame_rules.hpp"

#include <algorithm>
#include <cmath>

namespace quorient::fdi::skewed {
namespace {

/// One frame's parity must point so much better at an axis than at any other.
constexpr double off_margin = 1.1;

double square(double x)
{
    return x * x;
}

double norm(const PerAxis& values)
{
    double squares = 0;
    for (const double value : values) squares += square(value);
    return std::sqrt(squares);
}

}  // namespace

AxisComparison::AxisComparison(const geometry::Axes& axes, double interval_s, const field::Allowed& allowed, const FieldRules& rules)
    : axes_(axes),
      count_(static_cast<std::size_t>(axes.rows())),
      interval_s_(interval_s),
      floor_(allowed.figures.noise_floor_rad_s),
      allowed_(allowed),
      rules_(rules),
      noise_(count_, floor_, interval_s),
      erratic_(count_, interval_s)
{
    const double gain = square(allowed.figures.gain_floor);
    const double delay = square(allowed.delay_floor_s);
    floor_variances_ << square(allowed.figures.bias_floor_rad_s), gain, gain, gain, delay, delay, delay;
    begin(false);
}

Regressors AxisComparison::prior(bool rested) const
{
    const double gain = square(allowed_.gain());
    const double delay = square(allowed_.delay_s);
    Regressors variances;
    variances << square(allowed_.bias(rested)), gain, gain, gain, delay, delay, delay;
    return variances;
}

void AxisComparison::reset()
{
    begin(false);
    noise_.reset();
    erratic_.reset();
    sums_.clear();
}

void AxisComparison::begin(bool rested)
{
    allowance_.begin(prior(rested), floor_variances_);
    learned_.fill(Regressors::Zero());
}

void AxisComparison::admit(std::size_t axis, bool rested)
{
    allowance_.begin(prior(rested), floor_variances_);
    learned_[axis].setZero();
}

PerAxis AxisComparison::unlearned(const PerAxis& rates, const Regressors& regressors, AxisSet set) const
{
    PerAxis values{};
    for (std::size_t i = 0; i < count_; ++i)
        if (set.has(i)) values[i] = rates[i] - learned_[i].dot(regressors);
    return values;
}

Eigen::Vector3d AxisComparison::rate(const PerAxis& rates, const AxisParity& parity, const Eigen::Vector3d& last) const
{
    Regressors regressors = Regressors::Zero();
    regressors.head<4>() << 1, last;
    return parity.body(unlearned(rates, regressors, parity.set()));
}

Eigen::Vector3d AxisComparison::rate_without(std::size_t axis, const PerAxis& rates, const AxisParity& parity, const Eigen::Vector3d& last) const
{
    Regressors regressors = Regressors::Zero();
    regressors.head<4>() << 1, last;
    const PerAxis values = unlearned(rates, regressors, parity.set());
    return parity.body_without(axis, values, parity.residual(values));
}

Regressors AxisComparison::regressors_of(const field::Motion& motion) const
{
    const double dead = rules_.dead_zone ? std::sqrt(noise_.typical()) : 0;
    const Eigen::Vector3d acceleration = (motion.step_before + motion.step_after) / (2 * interval_s_);
    Regressors phi;
    phi(bias) = 1;
    for (Eigen::Index k = 0; k < 3; ++k) {
        phi(gain_x + k) = field::dead_zone(motion.rate(k), field::rate_dead_zone * dead);
        phi(delay_x + k) = field::dead_zone(acceleration(k), field::acceleration_dead_zone * dead / interval_s_);
    }
    return phi;
}

/// The variance that wandering sampling instants make of the motion, in every axis.
PerAxis AxisComparison::wander_of(const field::Motion& motion) const
{
    PerAxis wander{};
    const double all = (motion.step_before.squaredNorm() + motion.step_after.squaredNorm()) / 2;
    for (std::size_t i = 0; i < count_; ++i) {
        const auto along_axis = axes_.row(static_cast<Eigen::Index>(i));
        const double along = (square(along_axis.dot(motion.step_before)) + square(along_axis.dot(motion.step_after))) / 2;
        wander[i] = field::wander_variance(along, all);
    }
    return wander;
}

/// Scaled as a whole where it is longer than noise and allowances make it.
PerAxis AxisComparison::clipped(double allowance, const AxisParity& parity) const
{
    double own = 0;
    for (std::size_t i = 0; i < count_; ++i)
        if (parity.set().has(i)) own += noise_.own(i) / static_cast<double>(parity.set().size());
    const double limit = field::clip_limit(allowance, own);
    const double length = norm(residual_);
    PerAxis values = residual_;
    if (rules_.clipping && length > limit)
        for (double& value : values) value *= limit / length;
    return values;
}

/// The axis whose parity no noise and no allowance explains, neither as it is nor without its mean, if no other one explains it nearly as well.
AxisSet AxisComparison::off(const PerAxis& quick, double quick_allowance, const AxisParity& parity) const
{
    AxisSet found;
    if (parity.redundancy() < 2) return found;
    std::size_t likeliest = count_;
    double most = 0;
    double second = 0;
    for (std::size_t i = 0; i < count_; ++i) {
        if (!parity.set().has(i) || !parity.sees(i)) continue;
        const double along = std::abs(parity.split(i, quick).along);
        second = std::max(second, std::min(along, most));
        if (along <= most) continue;
        most = along;
        likeliest = i;
    }
    if (likeliest == count_ || most < off_margin * second) return found;
    const double limit = field::off_sigmas * std::sqrt(noise_.others(likeliest) + quick_allowance);
    if (most > limit && std::abs(parity.split(likeliest, residual_).along) > limit) found.add(likeliest);
    return found;
}

void AxisComparison::add_to_sums(const Regressors& regressors, double weight, const PerAxis& clipped, AxisSet compared)
{
    AxisSums sums;
    sums.axes = count_;
    sums.weight = weight;
    sums.weight_squared = weight * weight;
    const Direction shape = regressors.head<template_count>();
    sums.regressors = weight * shape * regressors.transpose();
    for (std::size_t i = 0; i < count_; ++i) {
        if (!compared.has(i)) continue;
        OneAxisSums& of = sums.axis[i];
        of.deviation = weight * clipped[i] * shape;
        of.unclipped = weight * residual_[i];
        of.noise = weight * weight * noise_.own(i);
        const double x = shape(1);
        const double y = shape(2);
        const double z = shape(3);
        of.shaped_noise << x * x, y * y, z * z, x * y, x * z, y * z;
        of.shaped_noise *= of.noise;
    }
    sums_.add(sums);
}

void AxisComparison::learn(const Regressors& regressors, const AxisParity& parity)
{
    const auto [gain, limit] = allowance_.learn(regressors, noise_.typical(), field::usual_colour);
    const double length = norm(residual_);
    const double longest = limit * std::sqrt(static_cast<double>(parity.redundancy()));
    const double scale = length > longest ? longest / length : 1;
    for (std::size_t i = 0; i < count_; ++i)
        if (parity.set().has(i)) learned_[i] += gain * (residual_[i] * scale);
    allowance_.add_variance(bias, square(allowed_.figures.bias_wander_rad_s_root_s) * interval_s_);
}

void AxisComparison::add(const field::Motion& motion, const Input& input)
{
    const AxisParity& parity = input.parity;
    const Regressors regressors = regressors_of(motion);
    const PerAxis wander = wander_of(motion);
    double mean_wander = 0;
    for (std::size_t i = 0; i < count_; ++i) mean_wander += wander[i] / static_cast<double>(count_);
    noise_.reckon(wander, parity);
    residual_ = parity.residual(unlearned(input.rates, regressors, parity.set()));
    const double allowance = allowance_.of(regressors);
    frame_bound_ = field::off_sigmas * std::sqrt(allowance + noise_.typical());
    const PerAxis counted = clipped(allowance, parity);
    const PerAxis quick = noise_.quick(residual_);
    Regressors moving = regressors;
    moving(bias) = 0;
    const AxisSet off_frame = off(quick, allowance_.of(moving), parity);
    erratic_.add({off_frame, {}, {}});
    add_to_sums(regressors, field::frame_weight(mean_wander, floor_), counted, input.compared);
    noise_.learn(parity, quick, counted);
    if (input.learns) learn(regressors, parity);
}

}  // namespace quorient::fdi::skewed
