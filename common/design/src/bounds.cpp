#include "quorient/design/bounds.hpp"

#include "numbers.hpp"
#include "places.hpp"
#include "quorient/messages/units.hpp"

#include <fmt/format.h>
#include <algorithm>
#include <cmath>
#include <numbers>

namespace quorient::design {

namespace {

constexpr double most_noise_ratio = 1e4;
constexpr std::size_t most_failure_sets = 500;
constexpr double decimal_rounding = 1e-9;  // demands are typed in decimals

double squared(double value)
{
    return value * value;
}

/// The sum of squares of the whitened rows: what n axes know in all.
double information(const Brief& brief)
{
    return brief.noise_of_axes().array().square().inverse().sum();
}

/// The most that is left after the worst failures of whole instruments is the mean over them.
BoundAfter after_instruments(const Brief& brief, unsigned failures)
{
    const auto units = static_cast<double>(brief.units());
    const double left = information(brief) * std::max(0.0, units - failures) / units;
    return {failures, 9 / left, std::pow(3 / left, 1.5)};
}

BoundAfter after_axes(const Brief& brief, unsigned failures)
{
    const auto n = static_cast<double>(brief.axis_count());
    const double m = n - failures;
    const double total = information(brief);
    if (m < 3) return {failures, infinity, infinity};
    return {failures, 9 / total * (n - 2) / (m - 2), std::sqrt(n * (n - 1) * (n - 2) / (m * (m - 1) * (m - 2))) * std::pow(3 / total, 1.5)};
}

/// Fejes Toth: of the smallest distance between `points` points on a sphere.
double point_bound_rad(double points)
{
    const double omega = points * pi / (6 * (points - 2));
    return std::acos((squared(1 / std::tan(omega)) - 1) / 2);
}

using Checked = tl::expected<void, Refusal>;

Checked refused(std::string demand, std::string reason)
{
    return tl::unexpected(Refusal{std::move(demand), std::move(reason)});
}

Checked check_count(const Brief& brief)
{
    const std::size_t n = brief.axis_count();
    if (n < 3) return refused("axes", fmt::format("{} axes: at least 3 are needed to measure a rotation", n));
    if (n > max_axes) return refused("axes", fmt::format("{} axes: a description on the wire holds at most {}", n, max_axes));
    return {};
}

/// The last failure needs an axis more than a parity equation has, unless the array is one of four: there the motion before it shows which axis.
Checked check_failures(const Brief& brief)
{
    const std::size_t k = brief.failures.value_or(0);
    const std::size_t n = brief.axis_count();
    if (k == 0) return {};
    if (brief.fails_by_instrument()) {
        if (brief.units() >= k + 2) return {};
        return refused("failures",
                       fmt::format("{} failures of {} instruments: with two left a difference does not show which is wrong; {} are needed",
                                   k, brief.units(), k + 2));
    }
    if (n < k + 3)
        return refused("failures", fmt::format("with {} of {} axes failed {} are left: 3 are needed to measure a rotation", k, n,
                                               n - std::min<std::size_t>(n, k)));
    if (n == 4 || n >= k + 4) return {};
    return refused("failures", fmt::format(
        "{} isolable failures of {} axes: after {} of them {} axes are left, whose one parity equation shows a further fault and not its "
        "axis; {} axes are needed",
        k, n, k - 1, n - k + 1, k + 4));
}

/// Every set of failures is judged: there must not be too many.
Checked check_sets(const Brief& brief)
{
    const unsigned k = brief.judged_failures();
    double sets = 1;
    for (unsigned failed = 0; failed < k; ++failed) sets *= static_cast<double>(brief.units() - failed) / (failed + 1);
    if (sets <= most_failure_sets) return {};
    return refused("failures", fmt::format("{} failures of {} can happen in {:.0f} ways: at most {} are judged", k, brief.units(), sets,
                                           most_failure_sets));
}

Checked check_simultaneous(const Brief& brief)
{
    const std::size_t n = brief.axis_count();
    if (brief.detectable > n - 3)
        return refused(
            "detectable",
            fmt::format(
                "{} simultaneous faults to be detected whatever their sizes: {} axes have {} parity equations and detect {}; {} axes are needed",
                brief.detectable, n, n - 3, n - 3, brief.detectable + 3));
    if (brief.isolable > (n - 3) / 2)
        return refused(
            "isolable",
            fmt::format(
                "{} simultaneous faults to be isolated whatever their sizes: that needs 2 parity equations for each, {} axes have {}; {} axes are needed",
                brief.isolable, n, n - 3, 2 * brief.isolable + 3));
    return {};
}

Checked check_angle(const Brief& brief)
{
    const double wanted = brief.minimum_angle_rad;
    if (wanted == 0) return {};
    const std::size_t n = brief.axis_count();
    const double most = largest_minimum_angle_rad(n);
    if (wanted > most + decimal_rounding)
        return refused("minimum_angle_deg",
                       fmt::format("{:g} deg between any two of {} axes: no {} lines in space keep more than {:.4f} deg ({})",
                                   wanted / degree, n, n, most / degree,
                                   n <= 6   ? "Fejes Toth 1965"
                                   : n == 7 ? "Rankin's bound"
                                            : "Rankin's and Fejes Toth's bounds"));
    for (Eigen::Index i = 0; i < brief.kept.rows(); ++i)
        for (Eigen::Index j = i + 1; j < brief.kept.rows(); ++j)
            if (std::abs(brief.kept.row(i).dot(brief.kept.row(j))) > std::cos(wanted) + decimal_rounding)
                return refused("minimum_angle_deg", fmt::format("{:g} deg between any two axes: axes {} and {}, which are kept, are closer",
                                                                wanted / degree, i, j));
    return {};
}

Checked check_limits(const Brief& brief, const Bounds& bounds)
{
    for (const Limit& limit : brief.limits) {
        const auto found = std::ranges::find(bounds.worst_after, limit.failures, &BoundAfter::failures);
        const bool whole = limit.failures == 0;
        if (!whole && found == bounds.worst_after.end())
            return refused("limits", fmt::format("a limit after {} failures: {} axes are judged after at most {}", limit.failures,
                                                 brief.axis_count(), bounds.worst_after.size()));
        const double trace = whole ? bounds.trace : found->trace;
        const double volume = whole ? bounds.volume : found->volume;
        const auto forbids = [&](const char* what, const std::optional<double>& wanted, double least) -> Checked {
            if (!wanted || *wanted >= least * (1 - decimal_rounding)) return {};
            return refused("limits", fmt::format("{} of at most {:g} after {} failures: no {} axes do better than {:.6g}", what, *wanted,
                                                 limit.failures, brief.axis_count(), least));
        };
        for (const Checked& checked : {forbids("a trace", limit.trace, trace), forbids("a volume", limit.volume, volume),
                                       forbids("a condition", limit.condition, 1)})
            if (!checked) return checked;
    }
    return {};
}

Checked check_mounted(const Brief& brief)
{
    if (const auto mounting = check_mounting(brief); !mounting) return refused("mounting", mounting.error());
    return {};
}

Checked check_noise(const Brief& brief)
{
    if (brief.noise.size() > 1 && brief.noise.size() != brief.instruments)
        return refused("noise", fmt::format("{} noises are given for {} instruments: one for all, or one for each", brief.noise.size(),
                                            brief.instruments));
    const geometry::AxisVector all = brief.noise_of_axes();
    if (!all.allFinite() || all.minCoeff() <= 0) return refused("noise", "a noise must be above 0 and finite");
    if (all.maxCoeff() > most_noise_ratio * all.minCoeff())
        return refused("noise",
                       fmt::format("noise from {:g} to {:g}{}: axes that differ by more than a factor of {:g} are no array", all.minCoeff(),
                                   all.maxCoeff(), brief.kept.rows() > 0 ? " (kept axes have 1)" : "", most_noise_ratio));
    return {};
}

Checked check_mission(const Brief& brief)
{
    if (!brief.mission) return {};
    const Mission& mission = *brief.mission;
    if (!(mission.hours > 0) || !std::isfinite(mission.hours))
        return refused("mission", fmt::format("a mission of {} h: it must be above 0 and finite", mission.hours));
    const std::size_t instruments = brief.all_instruments();
    for (const SharedPart& part : mission.shared)
        for (const std::size_t index : part.instruments)
            if (index >= instruments)
                return refused("mission", fmt::format("a shared part takes instrument {}: there are instruments 0..{}", index, instruments - 1));
    return {};
}

}  // namespace

double largest_minimum_angle_rad(std::size_t count)
{
    if (count <= 3) return pi / 2;
    if (count == 4) return std::acos(1.0 / 3);
    if (count <= 6) return std::acos(1 / std::sqrt(5.0));
    return std::min(std::acos(std::numbers::inv_sqrt3), point_bound_rad(2 * static_cast<double>(count)));
}

Bounds bounds(const Brief& brief)
{
    Bounds found;
    const auto n = static_cast<double>(brief.axis_count());
    const double total = information(brief);
    found.trace = 9 / total;
    found.volume = std::pow(3 / total, 1.5);
    found.minimum_angle_rad = largest_minimum_angle_rad(brief.axis_count());
    for (unsigned k = 1; k <= brief.judged_failures(); ++k)
        found.worst_after.push_back(brief.fails_by_instrument() ? after_instruments(brief, k) : after_axes(brief, k));
    found.f_d1 = (n - 3) / n;
    found.f_d2 = (n - 1) * (n - 3) / 3;
    found.detectable = static_cast<unsigned>(brief.axis_count() - 3);
    found.isolable = found.detectable / 2;
    return found;
}

tl::expected<Bounds, Refusal> check(const Brief& brief)
{
    using Check = Checked (*)(const Brief&);
    for (const Check one : {check_count, check_noise, check_failures, check_sets, check_simultaneous, check_angle, check_mission, check_mounted})
        if (const Checked checked = one(brief); !checked) return tl::unexpected(checked.error());
    Bounds found = bounds(brief);
    if (const Checked limits = check_limits(brief, found); !limits) return tl::unexpected(limits.error());
    return found;
}

}  // namespace quorient::design
