#include "quorient/calibration/calibration.hpp"

#include "quorient/calibration/axes_fit.hpp"
#include "quorient/geometry/sensor_cluster.hpp"

#include <fmt/format.h>
#include <Eigen/Dense>
#include <algorithm>
#include <bit>
#include <cmath>

namespace quorient::calibration {
namespace {

using geometry::AxisVector;

constexpr std::size_t fewest_at_limit = 5;     // an extreme value that occurs so often is a limit
constexpr double limit_deviations = 50.0;      // noise alone never repeats an extreme this far out
constexpr double near_limit = 0.975;           // share of the limit from which a MEMS gyro is no longer linear (1950 of 2000 deg/s)
constexpr double vibration_window_s = 0.25;    // long against the vibration of rotors, short against a manoeuvre
constexpr std::size_t most_blocks = 200'000;
constexpr std::size_t frames_after_limit = 3;  // its filter remembers the clipping for so long

std::size_t index(Eigen::Index axis)
{
    return static_cast<std::size_t>(axis);
}

/// The largest magnitude of an axis and how often exactly this value occurred.
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
    AxisVector highest;  // the two ends are kept apart: at one of them the codes may end one step earlier
    AxisVector lowest;
};

Limits saturation_limits(Samples samples, const RestFigures& rest)
{
    const Eigen::Index n = rest.bias_rad_s.size();
    std::array<Extreme, max_axes> up;
    std::array<Extreme, max_axes> down;
    for (const Sample& sample : samples)
        for (Eigen::Index axis = 0; sample.complete && axis < n; ++axis)
            (sample.rate(axis) > 0 ? up : down)[index(axis)].add(sample.rate(axis));
    Limits limits{AxisVector::Zero(n), AxisVector::Zero(n)};
    for (Eigen::Index axis = 0; axis < n; ++axis) {
        const double least = limit_deviations * rest.deviation_rad_s(axis);
        const auto reached = [least](const Extreme& extreme) { return extreme.times >= fewest_at_limit && extreme.magnitude > least; };
        if (reached(up[index(axis)])) limits.highest(axis) = up[index(axis)].magnitude;
        if (reached(down[index(axis)])) limits.lowest(axis) = down[index(axis)].magnitude;
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
        const Sample sample = samples[i];
        for (Eigen::Index axis = 0; axis < limits.highest.size(); ++axis) {
            const double size = std::abs(sample.rate(axis));
            const double limit = limit_of(limits, axis, nominal.range[index(axis)]);
            if (limit <= 0 || size < near_limit * limit) continue;
            clean_from = i + frames_after_limit + 1;
            const double end = sample.rate(axis) > 0 ? limits.highest(axis) : limits.lowest(axis);
            if (end > 0 && size >= end * (1 - 1e-9)) ++result.saturated[index(axis)];
        }
        usable[i] = sample.complete && i >= clean_from;
    }
    return usable;
}

std::string constant_axis(Samples samples)
{
    if (samples.empty()) return "the log has no frame";
    const AxisVector first = samples.front().rate;
    AxisMask changed = 0;
    for (const Sample& sample : samples) {
        for (Eigen::Index axis = 0; axis < first.size(); ++axis)
            if (std::abs(sample.rate(axis) - first(axis)) > 1e-12 * std::abs(first(axis))) changed |= axis_bit(index(axis));
        if (changed == all_axes(index(first.size()))) return {};
    }
    return fmt::format("axis {} is constant over the whole log: it is dead, or the log is", std::countr_one(changed));
}

void note_rest(Samples samples, Calibration& result)
{
    result.at_rest = rest_figures(samples, result.rest);
    result.allan = allan_deviation(samples, result.rest);
    result.allan_figures = allan_figures(result.allan);
}

/// Without rest: the mean of all samples, to begin with.
RestFigures mean_of_all(Samples samples)
{
    const Eigen::Index n = samples.front().rate.size();
    RestFigures figures{AxisVector::Zero(n), AxisVector::Zero(n), AxisVector::Zero(n)};
    double count = 0;
    for (const Sample& sample : samples) {
        if (!sample.complete) continue;
        figures.bias_rad_s += sample.rate;
        ++count;
    }
    figures.bias_rad_s /= std::max(1.0, count);
    return figures;
}

AxisVector of_axes(const AxisVector& values, const std::vector<Eigen::Index>& axes)
{
    AxisVector chosen(static_cast<Eigen::Index>(axes.size()));
    for (std::size_t i = 0; i < axes.size(); ++i) chosen(static_cast<Eigen::Index>(i)) = values(axes[i]);
    return chosen;
}

/// Without rest: the part of the means that no rotation explains, and the standard deviation of such parts.
/// @param rate_of  of the sound axes, without bias
/// @param sound    the axes of the fit; the others' figures stay
void keep_disagreement(const AxesFit& fit, Samples samples, const RateOf& rate_of, const std::vector<bool>& usable,
                       const std::vector<Eigen::Index>& sound, RestFigures& figures)
{
    const geometry::Axes h = fit.axes.array().colwise() * fit.gain.array();
    const Eigen::MatrixXd residual = Eigen::MatrixXd::Identity(h.rows(), h.rows()) - h * (h.transpose() * h).inverse() * h.transpose();
    const AxisVector bias = residual * of_axes(figures.bias_rad_s, sound);
    AxisVector squares = AxisVector::Zero(h.rows());
    double count = 0;
    for (std::size_t i = 0; i < samples.size(); ++i) {
        if (!usable[i]) continue;
        squares += AxisVector(residual * rate_of(samples[i])).cwiseAbs2();
        ++count;
    }
    const AxisVector share = residual.diagonal();
    const AxisVector deviation = (squares.array() / share.array() / std::max(1.0, count)).sqrt();
    for (std::size_t i = 0; i < sound.size(); ++i) {
        figures.bias_rad_s(sound[i]) = bias(static_cast<Eigen::Index>(i));
        figures.deviation_rad_s(sound[i]) = deviation(static_cast<Eigen::Index>(i));
    }
}

/// Means over blocks of usable samples in a row: manoeuvres stay, vibration (which each sensor samples at its own time) goes.
/// Very long logs have longer blocks, so that there are no more than most_blocks.
std::vector<AxisVector> block_means(Samples samples, const RateOf& rate_of, const std::vector<bool>& usable)
{
    const auto vibration = static_cast<std::size_t>(std::lround(vibration_window_s / samples.front().interval_s));
    const std::size_t length = std::max({std::size_t{1}, vibration, samples.size() / most_blocks});
    std::vector<AxisVector> means;
    AxisVector sum;
    std::size_t count = 0;
    for (std::size_t i = 0; i < samples.size(); ++i) {
        const Sample sample = samples[i];
        if (!usable[i] || !sample.follows) count = 0;
        if (!usable[i]) continue;
        if (count == 0) sum = rate_of(sample);
        else sum += rate_of(sample);
        if (++count < length) continue;
        means.emplace_back(sum / static_cast<double>(length));
        count = 0;
    }
    return means;
}

/// The motion of the samples that move and are usable.
RateMoment moving_rates(Samples samples, const RateOf& rate_of, const std::vector<bool>& usable, std::size_t axes, double noise_rad_s)
{
    RateMoment moving(static_cast<Eigen::Index>(axes));
    for (std::size_t i = 0; i < samples.size(); ++i) {
        if (!usable[i]) continue;
        const AxisVector rate = rate_of(samples[i]);
        if (std::sqrt(rate.squaredNorm() / static_cast<double>(axes)) > 10.0 * noise_rad_s) moving.add(rate);
    }
    return moving;
}

/// The motion of the blocks: without rest nothing says what moves.
RateMoment block_rates(Samples samples, const RateOf& rate_of, const std::vector<bool>& usable, std::size_t axes)
{
    RateMoment moving(static_cast<Eigen::Index>(axes));
    for (const AxisVector& mean : block_means(samples, rate_of, usable)) moving.add(mean);
    return moving;
}

/// @param sound  the axes of the fit; the others keep these nominal directions
void take_axes(const AxesFit& fit, const geometry::Axes& nominal, const std::vector<Eigen::Index>& sound, Calibration& result)
{
    result.axes_residual_rad_s = fit.residual_rad_s;
    for (Eigen::Index axis = 0; axis < nominal.rows(); ++axis)
        Eigen::Vector3d::Map(result.cluster.description.axis[index(axis)].data()) = nominal.row(axis);
    for (Eigen::Index i = 0; i < fit.axes.rows(); ++i) {
        const std::size_t axis = index(sound[index(i)]);
        const Eigen::Vector3d fitted = fit.axes.row(i);
        const Eigen::Vector3d before = nominal.row(sound[index(i)]);
        result.misalignment_rad[axis] = std::atan2(fitted.cross(before).norm(), fitted.dot(before));
        Eigen::Vector3d::Map(result.cluster.description.axis[axis].data()) = fitted;
        result.cluster.gain[axis] = fit.gain(i);
    }
}

/// An axis that was set aside is not corrected, and as noisy as the others.
void leave_raw(const std::vector<Eigen::Index>& sound, Calibration& result)
{
    std::vector<double> sigma;
    for (const Eigen::Index axis : sound) sigma.push_back(result.cluster.description.sigma[index(axis)]);
    std::ranges::sort(sigma);
    for (const OutsideClass& outside : result.outside) {
        result.cluster.description.bias[outside.axis] = 0;
        result.cluster.description.sigma[outside.axis] = sigma[sigma.size() / 2];
        result.cluster.bias_spread_rad_s[outside.axis] = 0;
    }
}

std::vector<Eigen::Index> sound_axes(std::size_t count, AxisMask outside)
{
    std::vector<Eigen::Index> sound;
    for (std::size_t axis = 0; axis < count; ++axis)
        if (!has_axis(outside, axis)) sound.push_back(static_cast<Eigen::Index>(axis));
    return sound;
}

/// Which instruments agree, from their raw rates.
Consensus compared(Samples samples, const std::vector<bool>& usable, const geometry::SensorCluster& cluster)
{
    return consensus_of(block_means(samples, [](const Sample& sample) { return sample.rate; }, usable), cluster);
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

/// What the nominal axes become before the fit: instruments with frames of their own are turned to the first one's.
geometry::Axes mounted_axes(const geometry::SensorCluster& cluster, const Consensus& consensus, const RateMoment& moving)
{
    if (!consensus.to_first.empty()) return turned(cluster.axes, cluster.instrument, consensus.to_first);
    return moving.samples() == 0 ? cluster.axes : mounted(moving, cluster.axes, cluster.instrument);
}

/// Axes, gains and motion noise from the sound axes.
/// @returns why not; the nominal axes stay then.
tl::expected<void, std::string> fit_motion(Samples samples, const geometry::SensorCluster& cluster, const Consensus& consensus,
                                           const std::vector<bool>& usable, Calibration& result)
{
    const auto sound = sound_axes(cluster.size(), consensus.outside_mask);
    const bool rested = !result.rest.empty();
    const double noise_rad_s = std::sqrt(result.at_rest.deviation_rad_s.squaredNorm() / static_cast<double>(cluster.size()));
    const RateOf unbiased = [&sound, bias = result.at_rest.bias_rad_s](const Sample& sample) { return of_axes(sample.rate - bias, sound); };
    const RateMoment moving = rested ? moving_rates(samples, unbiased, usable, sound.size(), noise_rad_s)
                                     : block_rates(samples, unbiased, usable, sound.size());
    if (!consensus.ambiguous.empty()) return tl::unexpected(consensus.ambiguous);
    const geometry::Axes axes = mounted_axes(cluster, consensus, moving);
    geometry::Axes nominal(static_cast<Eigen::Index>(sound.size()), 3);
    for (std::size_t i = 0; i < sound.size(); ++i) nominal.row(static_cast<Eigen::Index>(i)) = axes.row(sound[i]);
    const auto fit = fit_axes(moving, nominal);
    if (!fit) return tl::unexpected(fit.error());
    if (!rested) keep_disagreement(*fit, samples, unbiased, usable, sound, result.at_rest);
    take_axes(*fit, axes, sound, result);
    const RateOf corrected = [&](const Sample& sample) -> AxisVector { return unbiased(sample).cwiseQuotient(fit->gain); };
    const AxisVector deviation = of_axes(result.at_rest.deviation_rad_s, sound).cwiseQuotient(fit->gain);
    result.motion = motion_figures(samples, corrected, usable, fit->axes, deviation);
    result.cluster.jitter = result.motion->noise;
    return {};
}

}  // namespace

tl::expected<Calibration, std::string> calibrate(Samples samples, const ClusterDescription& nominal, const RestSettings& settings)
{
    const auto cluster = geometry::make_cluster(nominal);
    if (!cluster) return tl::unexpected(cluster.error());
    if (auto constant = constant_axis(samples); !constant.empty()) return tl::unexpected(std::move(constant));
    Calibration result;
    result.rest = resting_segments(samples, settings);
    const bool rested = !result.rest.empty();
    if (rested) note_rest(samples, result);
    else result.at_rest = mean_of_all(samples);

    const Limits limits = saturation_limits(samples, result.at_rest);
    const auto usable = usable_samples(samples, limits, nominal, result);

    result.cluster.description = nominal;
    result.cluster.gain.fill(1.0);
    const Consensus consensus = compared(samples, usable, *cluster);
    result.outside = consensus.outside;
    const auto fitted = fit_motion(samples, *cluster, consensus, usable, result);
    if (!fitted && !rested)
        return tl::unexpected(
            fmt::format("no resting segment of {} s (standard deviation below {} rad/s), and without one the axes must show the "
                        "biases by their disagreement: {}",
                        settings.shortest_s, settings.deviation_rad_s, fitted.error()));
    if (!fitted) result.axes_note = fitted.error();
    fill_cluster(nominal, limits, result);
    leave_raw(sound_axes(cluster->size(), consensus.outside_mask), result);
    return result;
}

}  // namespace quorient::calibration
