#include "quorient/geometry/sensor_cluster.hpp"

#include "quorient/geometry/redundancy.hpp"
#include "quorient/messages/meaning.hpp"
#include "quorient/messages/name.hpp"

#include <fmt/format.h>
#include <algorithm>
#include <cmath>
#include <optional>
#include <string_view>

namespace quorient::geometry {

namespace {

constexpr double norm_tolerance = 1e-4;  // admits axes typed in five decimals, and catches a forgotten normalisation

// No sensor is outside these limits. Beyond them the squares, their ratios and the solutions leave the range that a double resolves.
constexpr double least_noise = 1e-15, largest_noise = 1e3, largest_noise_ratio = 1e6;

using Problem = std::optional<std::string>;

Problem problem_with(const Axes& axes)
{
    const auto n = static_cast<std::size_t>(axes.rows());
    if (n < 3) return fmt::format("{} axes given; at least 3 are needed to measure a rotation", n);
    for (Eigen::Index axis = 0; axis < axes.rows(); ++axis)
        if (const auto problem = unit_norm_problem(axes.row(axis))) return fmt::format("axis {}: {}", axis, *problem);
    if (const int rank = rank_of(axes); rank < 3)
        return fmt::format("the {} axes all lie {}; at least one must point out of it", n, rank == 2 ? "in one plane" : "on one line");
    return std::nullopt;
}

Problem problem_with(const std::vector<std::size_t>& instrument, std::size_t axis_count)
{
    if (instrument.size() != axis_count) return fmt::format("{} instrument numbers given for {} axes", instrument.size(), axis_count);
    const std::size_t count = *std::ranges::max_element(instrument) + 1;
    for (std::size_t index = 0; index < count; ++index)
        if (std::ranges::find(instrument, index) == instrument.end())
            return fmt::format("instrument {} has no axis; number the instruments 0..{} without gaps", index, instrument.size() - 1);
    return std::nullopt;
}

std::vector<std::string> default_names(const std::vector<std::size_t>& instrument)
{
    const std::size_t count = *std::ranges::max_element(instrument) + 1;
    std::vector<std::string> names;
    for (std::size_t index = 0; index < count; ++index)
        names.push_back(fmt::format("{}{}", std::ranges::count(instrument, index) == 1 ? "G" : "IMU", index + 1));
    return names;
}

Problem problem_with(const char* what, const std::array<double, max_axes>& figure, std::size_t axis_count)
{
    for (std::size_t axis = 0; axis < axis_count; ++axis)
        if (!std::isfinite(figure[axis]) || figure[axis] < 0)
            return fmt::format("{} of axis {} is {}; a finite value of at least 0 is needed", what, axis, figure[axis]);
    return std::nullopt;
}

Problem problem_with_noise(const char* what, const std::array<double, max_axes>& figure, std::size_t axis_count)
{
    if (const auto problem = problem_with(what, figure, axis_count)) return problem;
    for (std::size_t axis = 0; axis < axis_count; ++axis)
        if (figure[axis] != 0 && (figure[axis] < least_noise || figure[axis] > largest_noise))
            return fmt::format("{} of axis {} is {}; 0 (unknown) or {:g} to {:g} is needed", what, axis, figure[axis], least_noise,
                               largest_noise);
    return std::nullopt;
}

Problem problem_with_ratio(const ClusterDescription& description, std::size_t axis_count)
{
    const auto ratio_too_large = [axis_count](auto figure_of) {
        double least = largest_noise, largest = 0;
        for (std::size_t axis = 0; axis < axis_count; ++axis) {
            const double figure = figure_of(axis);
            if (figure > 0) least = std::min(least, figure);
            largest = std::max(largest, figure);
        }
        return largest > largest_noise_ratio * least;
    };
    const auto& sigma = description.sigma;
    const auto& quantum = description.quantum;
    if (!ratio_too_large([&](std::size_t axis) { return sigma[axis]; }) &&
        !ratio_too_large([&](std::size_t axis) { return std::hypot(sigma[axis], quantum[axis]); }))
        return std::nullopt;
    return fmt::format("one axis has more than {:g} times the noise of another; leave it out of the cluster", largest_noise_ratio);
}

Problem problem_with(const ClusterDescription& description)
{
    const std::size_t n = description.axis_count;
    if (n > max_axes) return fmt::format("{} axes given; at most {} are supported", n, max_axes);
    if (!std::isfinite(description.interval_s) || description.interval_s < 0)
        return fmt::format("the interval is {} s; a finite value of at least 0 is needed", description.interval_s);
    if (const auto problem = problem_with_noise("the noise", description.sigma, n)) return problem;
    if (const auto problem = problem_with_noise("the quantum", description.quantum, n)) return problem;
    if (const auto problem = problem_with_ratio(description, n)) return problem;
    return problem_with("the range", description.range, n);
}

AxisVector first(const std::array<double, max_axes>& values, std::size_t count)
{
    return Eigen::Map<const Eigen::VectorXd>(values.data(), static_cast<Eigen::Index>(count));
}

}  // namespace

std::optional<std::string> unit_norm_problem(const Eigen::RowVector3d& axis)
{
    if (!axis.allFinite()) return fmt::format("({}, {}, {}) is not finite", axis(0), axis(1), axis(2));
    const double norm = axis.norm();
    if (std::abs(norm - 1) <= norm_tolerance) return std::nullopt;
    return fmt::format("norm {:.9g}; unit vectors (within {:g}) are needed, divide by the norm", norm, norm_tolerance);
}

AxisMask SensorCluster::axes_of(std::size_t instrument_index) const
{
    AxisMask mask = 0;
    for (std::size_t axis = 0; axis < size(); ++axis)
        if (instrument[axis] == instrument_index) mask |= axis_bit(axis);
    return mask;
}

tl::expected<SensorCluster, std::string> make_cluster(const Axes& axes, std::vector<std::size_t> instrument)
{
    if (auto problem = problem_with(axes)) return tl::unexpected(*problem);
    if (instrument.empty())
        for (std::size_t axis = 0; axis < static_cast<std::size_t>(axes.rows()); ++axis) instrument.push_back(axis);
    if (auto problem = problem_with(instrument, static_cast<std::size_t>(axes.rows()))) return tl::unexpected(*problem);

    SensorCluster cluster;
    cluster.axes = axes;
    cluster.instrument_name = default_names(instrument);
    cluster.instrument = std::move(instrument);
    cluster.sigma = cluster.quantum = cluster.range = AxisVector::Zero(axes.rows());
    return cluster;
}

tl::expected<SensorCluster, std::string> make_cluster(const ClusterDescription& description)
{
    if (auto problem = problem_with(description)) return tl::unexpected(*problem);
    const std::size_t n = description.axis_count;
    Axes axes(n, 3);
    for (std::size_t axis = 0; axis < n; ++axis)
        axes.row(static_cast<Eigen::Index>(axis)) = Eigen::Map<const Eigen::RowVector3d>(description.axis[axis].data());

    auto cluster = make_cluster(axes, {description.instrument.begin(), description.instrument.begin() + static_cast<std::ptrdiff_t>(n)});
    if (!cluster) return cluster;
    for (std::size_t index = 0; index < cluster->instrument_name.size(); ++index)
        if (const auto name = text_of(description.instrument_name[index]); !name.empty()) cluster->instrument_name[index] = name;
    cluster->sigma = first(description.sigma, n);
    cluster->quantum = first(description.quantum, n);
    cluster->range = first(description.range, n);
    cluster->interval_s = description.interval_s;
    cluster->kind = kind_of(description);
    return cluster;
}

}  // namespace quorient::geometry
