#include "quorient/design/figures.hpp"

#include "failure_sets.hpp"
#include "numbers.hpp"
#include "quorient/geometry/figures.hpp"
#include "quorient/geometry/redundancy.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <boost/random/uniform_real_distribution.hpp>
#include <cmath>
#include <limits>
#include <numbers>
#include <random>

namespace quorient::design {

namespace {

using Eigen::Index;
using Eigen::Vector3d;

constexpr double undefined = std::numeric_limits<double>::quiet_NaN();
constexpr double significant = 1e8;  // figures that agree to so many parts are the same
constexpr double negligible = 1e-2;   // relative: what a design must be better by to stand beside another

geometry::Axes whitened(const geometry::Axes& axes, const geometry::AxisVector& noise)
{
    return noise.cwiseInverse().asDiagonal() * axes;
}

AfterFailures worst_without(const geometry::Axes& rows, std::span<const AxisMask> removed, unsigned failures)
{
    AfterFailures worst{failures, 0, 0, 0};
    for (const AxisMask axes : removed) {
        const auto left = geometry::accuracy(rows, ~axes);
        if (!left) return {failures, infinity, infinity, infinity};
        worst.trace = std::max(worst.trace, left->trace);
        worst.volume = std::max(worst.volume, left->volume);
        worst.condition = std::max(worst.condition, left->condition);
    }
    return worst;
}

std::vector<AxisMask> sets_of(const Yardstick& yardstick, unsigned failures)
{
    return failure_sets(axes_of_units(yardstick.instrument, !yardstick.instrument_faults), failures);
}

/// Every instrument tilted by the error about a random line at right angles to its first axis.
geometry::Axes mounted(geometry::Axes axes, const Yardstick& yardstick, std::mt19937_64& random)
{
    boost::random::uniform_real_distribution<double> direction(0, 2 * std::numbers::pi);
    for (Index axis = 0; axis < axes.rows();) {
        const std::size_t instrument = yardstick.instrument[static_cast<std::size_t>(axis)];
        const Vector3d first = axes.row(axis);
        const Vector3d line = Eigen::AngleAxisd(direction(random), first) * first.unitOrthogonal();
        const Eigen::Matrix3d tilt = Eigen::AngleAxisd(yardstick.mounting_error_rad, line).toRotationMatrix();
        for (; axis < axes.rows() && yardstick.instrument[static_cast<std::size_t>(axis)] == instrument; ++axis)
            axes.row(axis) = axes.row(axis) * tilt.transpose();
    }
    return axes;
}

/// trace of (H'H)^-1 without these rows, from H'H of all rows: the sum of the second-order minors over the determinant.
double trace_without(const geometry::Axes& rows, const Eigen::Matrix3d& information, AxisMask removed)
{
    constexpr double clearly_regular = 1e-6;  // else the difference has lost digits, and the rows that are left are asked
    Eigen::Matrix3d left = information;
    for (Index axis = 0; axis < rows.rows(); ++axis)
        if (has_axis(removed, static_cast<std::size_t>(axis))) left.noalias() -= rows.row(axis).transpose() * rows.row(axis);
    const double minors = left(0, 0) * left(1, 1) - left(0, 1) * left(1, 0) + left(0, 0) * left(2, 2) - left(0, 2) * left(2, 0) +
                          left(1, 1) * left(2, 2) - left(1, 2) * left(2, 1);
    const double determinant = left.determinant();
    if (determinant > clearly_regular * std::pow(information.trace() / 3, 3)) return minors / determinant;
    const auto accuracy = geometry::accuracy(rows, ~removed);
    return accuracy ? accuracy->trace : infinity;
}

double worst_mounted_trace(const geometry::Axes& axes, const Yardstick& yardstick)
{
    std::seed_seq sequence{yardstick.seed, std::uint64_t{0x6d6f756e74}};
    std::mt19937_64 random(sequence);
    const auto removed = sets_of(yardstick, yardstick.failures);
    double worst = 0;
    for (unsigned trial = 0; trial < random_mountings; ++trial) {
        const geometry::Axes rows = whitened(mounted(axes, yardstick, random), yardstick.noise);
        const Eigen::Matrix3d information = rows.transpose() * rows;
        for (const AxisMask axes_removed : removed) worst = std::max(worst, trace_without(rows, information, axes_removed));
    }
    return worst;
}

/// 8 digits behind the first, so that the last digits of different searches do not decide.
double rounded_to_significant(double value)
{
    if (!std::isfinite(value) || value == 0) return value;
    const double scale = std::pow(10, std::floor(std::log10(std::abs(value))));
    return std::round(value / scale * significant) / significant * scale;
}

double less_is_better(double value)
{
    return std::isnan(value) ? infinity : value;
}

double more_is_better(double value)
{
    return std::isnan(value) ? infinity : -value;
}

/// What decides where the objective does not, and what makes the front.
std::vector<double> merits(const Figures& figures)
{
    std::vector<double> list{less_is_better(figures.trace)};
    for (const AfterFailures& after : figures.worst_after) list.push_back(less_is_better(after.trace));
    list.push_back(more_is_better(figures.f_d2));
    list.push_back(-figures.minimum_angle_rad);
    return list;
}

}  // namespace

Yardstick Yardstick::of(const Brief& brief, std::uint64_t seed)
{
    return {brief.noise_of_axes(), brief.instrument_of_axes(), brief.fails_by_instrument(), brief.judged_failures(), brief.mounting_error_rad, seed};
}

Yardstick Yardstick::of(const geometry::SensorCluster& cluster, unsigned failures)
{
    return {geometry::AxisVector::Ones(static_cast<Index>(cluster.size())), cluster.instrument, false, failures, 0, 1};
}

Figures judge(const geometry::Axes& axes, const Yardstick& yardstick)
{
    Figures figures;
    const geometry::Axes rows = whitened(axes, yardstick.noise);
    const AfterFailures whole = worst_without(rows, sets_of(yardstick, 0), 0);
    figures.trace = whole.trace;
    figures.volume = whole.volume;
    figures.condition = whole.condition;
    figures.minimum_angle_rad = geometry::minimum_angle_rad(axes).value_or(undefined);
    for (unsigned k = 1; k <= yardstick.failures; ++k) figures.worst_after.push_back(worst_without(rows, sets_of(yardstick, k), k));
    const geometry::ParitySpace space(rows);
    figures.f_d1 = geometry::f_d1(space);
    figures.f_d2 = geometry::f_d2(space);
    figures.detectable =
        yardstick.instrument_faults ? geometry::detectable_instruments_with(axes, yardstick.instrument) : geometry::detectable_with(axes);
    figures.isolable = figures.detectable / 2;
    figures.fault = yardstick.fault_sizes ? fault_sizes(space, yardstick.probabilities) : FaultSizes{undefined, undefined, undefined, undefined};
    if (yardstick.mounting_error_rad > 0) figures.mounted_trace = worst_mounted_trace(axes, yardstick);
    return figures;
}

bool is_fault_size(Objective objective)
{
    return objective == Objective::detected_axis || objective == Objective::isolated_axis || objective == Objective::detected_pair ||
           objective == Objective::isolated_pair;
}

const std::vector<ObjectiveEntry>& objectives()
{
    static const std::vector<ObjectiveEntry> list{
        {Objective::trace, "trace", "variance of the body vector with all axes: the sum over its three components", "002"},
        {Objective::volume, "volume", "volume of its ellipsoid of scatter", "002"},
        {Objective::condition, "condition", "its largest over its smallest variance", "002"},
        {Objective::worst_trace, "worst_trace", "the trace after the most failures judged, worst case", "002"},
        {Objective::worst_volume, "worst_volume", "the volume after them", "002"},
        {Objective::worst_condition, "worst_condition", "the condition after them", "002"},
        {Objective::minimum_angle, "minimum_angle", "smallest angle between two axes", "002"},
        {Objective::f_d1, "F_d1", "detection of the worst axis: the smallest J_j", "004, eq 22"},
        {Objective::f_d2, "F_d2", "isolation of the worst axis: the smallest J_ii over the next", "004, eq 42"},
        {Objective::detected_axis, "detected_axis", "smallest fault that is detected on the worst axis, in sigma", "Daly, Gai & Harrison"},
        {Objective::isolated_axis, "isolated_axis", "smallest fault that is isolated on the worst axis, in sigma", "Daly, Gai & Harrison"},
        {Objective::detected_pair, "detected_pair", "smallest two equal faults that are detected, worst pair", "Daly, Gai & Harrison"},
        {Objective::isolated_pair, "isolated_pair", "two equal faults below which no method can tell the worst pair", "likelihood of two hypotheses"},
        {Objective::mounted_trace, "mounted_trace", "worst_trace in the worst of 200 mountings with the error of --mounting-error", "002"},
        {Objective::survival, "survival", "probability of reaching the end of the mission", "Monte Carlo of the detection method"},
    };
    return list;
}

double cost(const Figures& figures, Objective objective)
{
    const AfterFailures last =
        figures.worst_after.empty() ? AfterFailures{0, figures.trace, figures.volume, figures.condition} : figures.worst_after.back();
    switch (objective) {
        case Objective::trace: return less_is_better(figures.trace);
        case Objective::volume: return less_is_better(figures.volume);
        case Objective::condition: return less_is_better(figures.condition);
        case Objective::worst_trace: return less_is_better(last.trace);
        case Objective::worst_volume: return less_is_better(last.volume);
        case Objective::worst_condition: return less_is_better(last.condition);
        case Objective::minimum_angle: return more_is_better(figures.minimum_angle_rad);
        case Objective::f_d1: return more_is_better(figures.f_d1);
        case Objective::f_d2: return more_is_better(figures.f_d2);
        case Objective::detected_axis: return less_is_better(figures.fault.detected_axis);
        case Objective::isolated_axis: return less_is_better(figures.fault.isolated_axis);
        case Objective::detected_pair: return less_is_better(figures.fault.detected_pair);
        case Objective::isolated_pair: return less_is_better(figures.fault.isolated_pair);
        case Objective::mounted_trace: return less_is_better(figures.mounted_trace.value_or(last.trace));
        case Objective::survival: return figures.survival ? -figures.survival->probability : 0;
    }
    return infinity;
}

double single_cost(const geometry::Axes& axes, const Yardstick& yardstick, Objective objective)
{
    const auto of_space = [&](auto figure) { return figure(geometry::ParitySpace(whitened(axes, yardstick.noise)), yardstick.probabilities); };
    switch (objective) {
        case Objective::detected_axis: return of_space(detected_axis);
        case Objective::isolated_axis: return of_space(isolated_axis);
        case Objective::detected_pair: return of_space(detected_pair);
        case Objective::isolated_pair: return of_space(isolated_pair);
        case Objective::mounted_trace:
            return yardstick.mounting_error_rad > 0 ? worst_mounted_trace(axes, yardstick) : cost(judge(axes, yardstick), objective);
        case Objective::condition: return worst_without(whitened(axes, yardstick.noise), sets_of(yardstick, 0), 0).condition;
        case Objective::worst_condition:
            return worst_without(whitened(axes, yardstick.noise), sets_of(yardstick, yardstick.failures), yardstick.failures).condition;
        default: return cost(judge(axes, yardstick), objective);
    }
}

bool better(const Figures& first, const Figures& second, Objective objective)
{
    const double own = rounded_to_significant(cost(first, objective));
    const double other = rounded_to_significant(cost(second, objective));
    if (own != other) return own < other;
    return std::ranges::lexicographical_compare(merits(first), merits(second), {}, rounded_to_significant, rounded_to_significant);
}

bool as_good(const Figures& first, const Figures& second, Objective objective)
{
    auto own = merits(first);
    auto other = merits(second);
    own.push_back(cost(first, objective));
    other.push_back(cost(second, objective));
    return std::ranges::equal(own, other, [](double a, double b) { return a <= b + negligible * std::abs(b) || a == b; });
}

unsigned named_in_turn(const Figures& figures)
{
    return figures.detectable > 0 ? figures.detectable - 1 : 0;
}

bool names_failures(const Figures& figures, const Brief& brief)
{
    constexpr std::size_t predicted = 4;  // axes
    return named_in_turn(figures) >= brief.failures.value_or(0) || (brief.axis_count() == predicted && !brief.fails_by_instrument());
}

double shortfall(const Figures& figures, const Brief& brief)
{
    constexpr double close = 1e-9;
    double missing = 0;
    const auto count = [&](const std::optional<double>& wanted, double reached) {
        if (wanted && !(reached <= *wanted * (1 + close))) missing += std::isfinite(reached) ? reached / *wanted - 1 : 1e6;
    };
    for (const Limit& limit : brief.limits) {
        AfterFailures reached{0, figures.trace, figures.volume, figures.condition};
        if (limit.failures > 0) reached = figures.worst_after[limit.failures - 1];
        count(limit.trace, reached.trace);
        count(limit.volume, reached.volume);
        count(limit.condition, reached.condition);
    }
    if (figures.minimum_angle_rad < brief.minimum_angle_rad - close) missing += brief.minimum_angle_rad - figures.minimum_angle_rad;
    if (figures.detectable < brief.detectable) missing += brief.detectable - figures.detectable;
    if (figures.isolable < brief.isolable) missing += brief.isolable - figures.isolable;
    const bool measures =
        std::isfinite(figures.trace) && (!brief.failures || figures.worst_after.empty() || std::isfinite(figures.worst_after.back().trace));
    if (!measures) missing += 1e6;
    return missing;
}

}  // namespace quorient::design
