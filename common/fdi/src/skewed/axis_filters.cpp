#include "skewed/axis_filters.hpp"

#include <algorithm>
#include <cmath>

namespace quorient::fdi::skewed {

using field::Filter;
using field::Suspicion;
using field::Suspicions;

struct AxisFilters::Window {
    const AxisSums& sums;
    const AxisWindows& ring;
    const Allowance& allowance;
    const AxisParity& parity;  ///< for the axes that are compared through the whole window
    PerAxis biases;            ///< residual of the sums with a constant template, clipped or not
    PerAxis unclipped;
    std::size_t frames;
    bool lasting;
};

namespace {

/// The filter's template along this axis, in terms of [1, omega].
Direction shape_of(Filter filter, const geometry::Axes& axes, std::size_t axis)
{
    Direction shape = Direction::Zero();
    if (filter == Filter::bias) shape(0) = 1;
    else shape.tail<3>() = axes.row(static_cast<Eigen::Index>(axis)).transpose();
    return shape;
}

PerAxis noise_of(const AxisSums& sums, Filter filter, const Direction& shape)
{
    PerAxis noise{};
    const double x = shape(1);
    const double y = shape(2);
    const double z = shape(3);
    Eigen::Matrix<double, 6, 1> squares;
    squares << x * x, y * y, z * z, 2 * x * y, 2 * x * z, 2 * y * z;
    for (std::size_t i = 0; i < sums.axes; ++i)
        noise[i] = filter == Filter::bias ? sums.axis[i].noise : std::max(0.0, squares.dot(sums.axis[i].shaped_noise));
    return noise;
}

PerAxis deviations_of(const AxisSums& sums, const Direction& shape)
{
    PerAxis values{};
    for (std::size_t i = 0; i < sums.axes; ++i) values[i] = shape.dot(sums.axis[i].deviation);
    return values;
}

AxisSet through(AxisSet compared, const field::Ages& age, std::size_t frames)
{
    AxisSet set = compared;
    for (std::size_t i = 0; i < max_axes; ++i)
        if (age[i] < frames) set.remove(i);
    return set;
}

}  // namespace

AxisFilters::AxisFilters(const geometry::Axes& axes, double interval_s, const FieldRules& rules)
    : axes_(axes), count_(static_cast<std::size_t>(axes.rows())), rules_(rules), windows_(interval_s)
{
}

Suspicions AxisFilters::examine(const AxisWindows& sums, const Allowance& allowance, AxisSet compared, const field::Ages& age,
                                std::uint64_t frame) const
{
    Suspicions found;
    AxisParity parity;
    for (std::size_t w = 0; w < field::Windows::lengths.size(); ++w) {
        const std::size_t frames = field::Windows::lengths[w];
        if (windows_.is_too_long(frames)) break;
        if (!field::Windows::is_due(w, frame)) continue;
        const AxisSet set = through(compared, age, frames);
        if (!(set == parity.set())) parity = AxisParity(axes_, set);
        if (parity.redundancy() < 2) continue;
        const AxisSums over = sums.over(frames);
        if (!field::Windows::is_even(frames, over.weight, over.weight_squared)) continue;
        PerAxis unclipped{};
        for (std::size_t i = 0; i < count_; ++i) unclipped[i] = over.axis[i].unclipped;
        unclipped = parity.residual(unclipped);
        const bool lasting = windows_.is_lasting(frames);
        const PerAxis counted = lasting ? parity.residual(deviations_of(over, Direction::UnitX())) : unclipped;
        const Window window{over, sums, allowance, parity, counted, unclipped, frames, lasting};
        for (std::size_t i = 0; i < count_; ++i) {
            if (!set.has(i) || !parity.sees(i)) continue;
            examine(window, i, Filter::bias, window.biases, found);
            if (frames < field::Windows::shortest_shaped) continue;
            examine(window, i, Filter::gain, parity.residual(deviations_of(over, shape_of(Filter::gain, axes_, i))), found);
        }
    }
    return found;
}

/// Variance of a sum along the parity of one axis.
double AxisFilters::noise_along(const AxisParity& parity, std::size_t axis, const PerAxis& noise) const
{
    double variance = 0;
    for (std::size_t i = 0; i < count_; ++i)
        if (parity.set().has(i)) variance += parity.share(axis, i) * parity.share(axis, i) * noise[i];
    return variance / parity.share(axis, axis);
}

void AxisFilters::examine(const Window& window, std::size_t axis, Filter filter, const PerAxis& residual, Suspicions& found) const
{
    const AxisParity& parity = window.parity;
    const Direction shape = shape_of(filter, axes_, axis);
    const Regressors regressors = window.sums.regressors.transpose() * shape;
    const double variance = window.allowance.of(regressors) + noise_along(parity, axis, noise_of(window.sums, filter, shape));
    const auto [along, others] = parity.split(axis, residual);
    const double rho = rules_.others_must_agree ? field::Windows::scatter_factor(parity.redundancy() - 1) : 0;
    const double bound = field::Windows::sigmas(filter != Filter::bias, window.lasting) * std::sqrt(variance) +
                         rho * std::sqrt(parity.share(axis, axis)) * others;
    const double certain = bound > 0 ? std::abs(along) / bound : 0;
    found.take({certain, axis, 0, window.frames, filter}, window.lasting, [&] { return !rules_.persistence || persists(window, axis, shape); },
               [&] { return filter == Filter::bias && (!rules_.smallest_angle || matters(window, axis)); });
}

/// Whether an attitude that follows this axis would notice.
bool AxisFilters::matters(const Window& window, std::size_t axis) const
{
    const double difference = window.unclipped[axis] / window.parity.share(axis, axis);
    return std::abs(difference) * windows_.seconds(window.frames) > windows_.least_angle_rad(window.frames) * window.sums.weight;
}

bool AxisFilters::persists(const Window& window, std::size_t axis, const Direction& shape) const
{
    const auto contradiction = [&](const AxisSums& totals) {
        double sum = 0;
        for (std::size_t i = 0; i < count_; ++i)
            if (window.parity.set().has(i)) sum += window.parity.share(axis, i) * shape.dot(totals.axis[i].deviation);
        return sum;
    };
    const auto energy = [&](const AxisSums& totals) { return shape.dot(totals.regressors.leftCols<template_count>() * shape); };
    return windows_.persists(window.frames, [&](std::size_t age) { return window.ring.total(age, contradiction); },
                             [&](std::size_t age) { return window.ring.total(age, energy); });
}

Suspicion AxisFilters::disagreement(const AxisWindows& sums, const Allowance& allowance, AxisSet compared, const field::Ages& age,
                                    std::uint64_t frame) const
{
    Suspicion most;
    const AxisParity parity(axes_, compared);
    if (parity.redundancy() != 1) return most;
    std::size_t axis = 0;
    while (!compared.has(axis) || !parity.sees(axis)) ++axis;
    for (std::size_t w = 0; w < field::Windows::lengths.size(); ++w) {
        const std::size_t frames = field::Windows::lengths[w];
        if (!field::Windows::is_due(w, frame) || windows_.is_too_long(frames) || !(through(compared, age, frames) == compared)) continue;
        const AxisSums over = sums.over(frames);
        const Direction shape = Direction::UnitX();
        const double along = std::abs(parity.split(axis, parity.residual(deviations_of(over, shape))).along);
        const double variance = allowance.of(over.regressors.row(0).transpose()) + noise_along(parity, axis, noise_of(over, Filter::bias, shape));
        const double certain = along / (field::Windows::disagreement_level * field::Windows::lasting_sigmas * std::sqrt(variance) + 1e-300);
        if (along * windows_.seconds(frames) <= field::Windows::least_lasting_angle_rad * over.weight || certain <= most.certainty) continue;
        most = {certain, axis, 0, frames, Filter::bias};
    }
    return most;
}

}  // namespace quorient::fdi::skewed
