#include "quorient/calibration/calibration.hpp"

#include "quorient/calibration/axes_fit.hpp"
#include "quorient/geometry/sensor_cluster.hpp"

#include <fmt/format.h>
#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

namespace quorient::calibration {
namespace {

using geometry::AxisVector;

constexpr std::size_t fewest_at_limit = 5;     // times that one extreme value comes before it is called a limit
constexpr double limit_deviations = 50.0;      // noise alone never repeats an extreme this far out
constexpr double near_limit = 0.975;           // of the limit: from here a MEMS gyro is not linear any more (1950 of 2000 deg/s)
constexpr std::size_t frames_after_limit = 3;  // that its filter still remembers the clipping

std::size_t index(Eigen::Index axis)
{
    return static_cast<std::size_t>(axis);
}

/// The largest magnitude of an axis and how often exactly it came.
struct Extreme {
    double magnitude = 0;
    std::size_t times = 0;

    void add(double rate)
    {
        const double size = std::abs(rate);
        const double rounding = 1e-12 * size;  // rates come from increments divided by jittering intervals
        if (size > magnitude + rounding) *this = {size, 1};
        else if (size >= magnitude - rounding) ++times;
    }
};

struct Limits {
    AxisVector highest;  // at one end the codes may end one step earlier: the ends are told apart
    AxisVector lowest;
};

Limits saturation_limits(Samples samples, const RestFigures& rest)
{
    const Eigen::Index n = rest.bias_rad_s.size();
    Limits limits{AxisVector::Zero(n), AxisVector::Zero(n)};
    for (Eigen::Index axis = 0; axis < n; ++axis) {
        Extreme up;
        Extreme down;
        for (const Sample& sample : samples)
            if (sample.complete) (sample.rate(axis) > 0 ? up : down).add(sample.rate(axis));
        const double least = limit_deviations * rest.deviation_rad_s(axis);
        if (up.times >= fewest_at_limit && up.magnitude > least) limits.highest(axis) = up.magnitude;
        if (down.times >= fewest_at_limit && down.magnitude > least) limits.lowest(axis) = down.magnitude;
    }
    return limits;
}

double limit_of(const Limits& limits, Eigen::Index axis, double stated)
{
    const double seen = std::max(limits.highest(axis), limits.lowest(axis));
    return seen > 0 ? seen : stated;
}

/// Which samples are complete and away from every axis's limit, also in the frames before.
std::vector<bool> usable_samples(Samples samples, const Limits& limits, const ClusterDescription& nominal, Calibration& result)
{
    std::vector<bool> usable(samples.size(), true);
    std::size_t clean_from = 0;
    for (std::size_t i = 0; i < samples.size(); ++i) {
        for (Eigen::Index axis = 0; axis < limits.highest.size(); ++axis) {
            const double size = std::abs(samples[i].rate(axis));
            const double limit = limit_of(limits, axis, nominal.range[index(axis)]);
            if (limit <= 0 || size < near_limit * limit) continue;
            clean_from = i + frames_after_limit + 1;
            const double end = samples[i].rate(axis) > 0 ? limits.highest(axis) : limits.lowest(axis);
            if (end > 0 && size >= end * (1 - 1e-9)) ++result.saturated[index(axis)];
        }
        usable[i] = samples[i].complete && i >= clean_from;
    }
    return usable;
}

tl::expected<void, std::string> note_rest(Samples samples, Calibration& result, const RestSettings& settings)
{
    result.rest = resting_segments(samples, settings);
    if (result.rest.empty())
        return tl::unexpected(
            fmt::format("no resting segment of {} s in the log: biases and noise cannot be told from motion (at rest means a standard "
                        "deviation below {} rad/s and a mean near the other segments')",
                        settings.shortest_s, settings.deviation_rad_s));
    result.at_rest = rest_figures(samples, result.rest);
    result.allan = allan_deviation(samples, result.rest);
    result.allan_figures = allan_figures(result.allan);
    const AxisVector first = samples[result.rest.front().begin].rate;
    for (Eigen::Index axis = 0; axis < first.size(); ++axis) {
        const auto changes = [&](const Sample& sample) {
            return std::abs(sample.rate(axis) - first(axis)) > 1e-12 * std::abs(first(axis));
        };
        if (std::none_of(samples.begin(), samples.end(), changes))
            return tl::unexpected(fmt::format("axis {} is constant over the whole log: it is dead, or the log is", axis));
    }
    return {};
}

/// Rates without bias of the samples that move and are usable.
std::vector<AxisVector> moving_rates(const std::vector<AxisVector>& unbiased, const std::vector<bool>& usable, double noise_rad_s)
{
    std::vector<AxisVector> moving;
    for (std::size_t i = 0; i < unbiased.size(); ++i) {
        const double rms = std::sqrt(unbiased[i].squaredNorm() / static_cast<double>(unbiased[i].size()));
        if (usable[i] && rms > 10.0 * noise_rad_s) moving.push_back(unbiased[i]);
    }
    return moving;
}

void take_axes(const AxesFit& fit, const geometry::Axes& nominal, Calibration& result)
{
    result.axes_residual_rad_s = fit.residual_rad_s;
    for (Eigen::Index axis = 0; axis < nominal.rows(); ++axis) {
        const Eigen::Vector3d fitted = fit.axes.row(axis);
        const Eigen::Vector3d before = nominal.row(axis);
        result.misalignment_rad[index(axis)] = std::atan2(fitted.cross(before).norm(), fitted.dot(before));
        Eigen::Vector3d::Map(result.cluster.description.axis[index(axis)].data()) = fitted;
        result.cluster.gain[index(axis)] = fit.gain(axis);
    }
}

/// Figures of the corrected increments: raw minus bias, divided by the gain.
void fill_cluster(const ClusterDescription& nominal, const Limits& limits, Calibration& result)
{
    auto& cluster = result.cluster;
    for (Eigen::Index axis = 0; axis < limits.highest.size(); ++axis) {
        const std::size_t i = index(axis);
        const double gain = cluster.gain[i];
        const double quantum = nominal.quantum[i];
        const double deviation = result.at_rest.deviation_rad_s(axis) * nominal.interval_s;
        const double range = nominal.range[i] > 0 ? nominal.range[i] : limit_of(limits, axis, 0);
        result.saturation_limit_rad_s[i] = std::max(limits.highest(axis), limits.lowest(axis));
        cluster.description.bias[i] = result.at_rest.bias_rad_s(axis);
        cluster.description.sigma[i] = std::max(deviation, quantum / std::sqrt(12.0)) / gain;
        cluster.description.quantum[i] = quantum / gain;
        cluster.description.range[i] = range > 0 ? (range + std::abs(result.at_rest.bias_rad_s(axis))) / gain : 0;
        cluster.bias_spread_rad_s[i] = result.at_rest.bias_spread_rad_s(axis);
    }
}

}  // namespace

tl::expected<Calibration, std::string> calibrate(Samples samples, const ClusterDescription& nominal, const RestSettings& settings)
{
    const auto cluster = geometry::make_cluster(nominal);
    if (!cluster) return tl::unexpected(cluster.error());
    Calibration result;
    if (const auto rested = note_rest(samples, result, settings); !rested) return tl::unexpected(rested.error());

    const Limits limits = saturation_limits(samples, result.at_rest);
    const auto usable = usable_samples(samples, limits, nominal, result);
    std::vector<AxisVector> rates;
    rates.reserve(samples.size());
    for (const Sample& sample : samples) rates.emplace_back(sample.rate - result.at_rest.bias_rad_s);

    result.cluster.description = nominal;
    result.cluster.gain.fill(1.0);
    const double noise_rad_s = std::sqrt(result.at_rest.deviation_rad_s.squaredNorm() / static_cast<double>(cluster->size()));
    const auto fit = fit_axes(moving_rates(rates, usable, noise_rad_s), cluster->axes, noise_rad_s);
    if (fit) {
        take_axes(*fit, cluster->axes, result);
        for (AxisVector& rate : rates) rate = rate.cwiseQuotient(fit->gain);
        result.motion = motion_figures(samples, rates, usable, fit->axes, result.at_rest.deviation_rad_s.cwiseQuotient(fit->gain));
        result.cluster.jitter_along_s = result.motion->noise.along_s;
        result.cluster.jitter_across_s = result.motion->noise.across_s;
    } else {
        result.axes_note = fit.error();
    }
    fill_cluster(nominal, limits, result);
    return result;
}

}  // namespace quorient::calibration
