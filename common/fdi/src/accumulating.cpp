#include "quorient/fdi/accumulating.hpp"

#include "quorient/fdi/noise.hpp"
#include "quorient/geometry/redundancy.hpp"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>

namespace quorient::fdi {
namespace {

constexpr std::array<std::size_t, 18> windows{1, 2, 3, 4, 6, 8, 12, 16, 24, 32, 48, 64, 96, 128, 192, 256, 384, Accumulating::longest_window};

/// A window is looked at this often in its own length: what is in between differs little.
constexpr std::size_t looks_per_window = 8;

/// An axis this close to its range may be beyond it; so are its neighbours in time, for the sensor has a bandwidth.
constexpr double saturation = 0.975;
constexpr unsigned frames_held_out = 4;

constexpr double calming = 1.0 / 16;  ///< per frame, of the wildness

constexpr double default_margin = 1.25;
constexpr double default_false_alarms_per_hour = 0.1;

constexpr std::size_t stride_of(std::size_t window) { return std::max<std::size_t>(1, window / looks_per_window); }

/// A small symmetric matrix over the axes of one instrument. Never on the heap.
using BlockMatrix = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::ColMajor, static_cast<int>(max_axes), static_cast<int>(max_axes)>;

double looks_per_frame()
{
    double looks = 0;
    for (const std::size_t window : windows) looks += 1 / static_cast<double>(stride_of(window));
    return looks;
}

}  // namespace

tl::expected<std::unique_ptr<Accumulating>, std::string> Accumulating::make(const DetectorSettings& settings,
                                                                            const geometry::SensorCluster& cluster, const MotionNoise& motion)
{
    if (const auto figures = check_figures(settings); !figures) return tl::unexpected(figures.error());
    if (const auto enough = require_axes(cluster, 4, "accumulating"); !enough) return tl::unexpected(enough.error());
    if (const auto pfa = false_alarm_probability(settings); !pfa) return tl::unexpected(pfa.error());
    if (const auto sigma = sigma_of_axes(settings, cluster); !sigma) return tl::unexpected(sigma.error());
    for (const double figure : {motion.jitter_along_s, motion.jitter_across_s, motion.rate_error, motion.bias_floor_rad_s, motion.lag_s})
        if (!(figure >= 0 && std::isfinite(figure))) return tl::unexpected(std::string("accumulating: the motion noise must be finite and at least 0"));
    return std::unique_ptr<Accumulating>(new Accumulating(settings, cluster, motion));
}

Accumulating::Accumulating(const DetectorSettings& settings, const geometry::SensorCluster& cluster, const MotionNoise& motion)
    : cluster_(cluster), variance_(sigma_of_axes(settings, cluster)->cwiseAbs2()), motion_(motion), instruments_(settings.instruments),
      margin_(settings.margin.value_or(default_margin)), totals_(history_length)
{
    const double frames_per_hour = 3600 / cluster.interval_s;
    false_alarms_per_hour_ = settings.pfa ? *settings.pfa * frames_per_hour : default_false_alarms_per_hour;
    const double tests_per_hour = frames_per_hour * looks_per_frame() * static_cast<double>(cluster.size());
    for (unsigned dof = 1; dof <= max_axes; ++dof)
        threshold_[dof] = chi_square_quantile(dof, std::min(0.5, false_alarms_per_hour_ / tests_per_hour));
    for (Totals& totals : totals_) totals.angle = geometry::AxisVector::Zero(cluster.axes.rows());
    blocks_.reserve(max_axes);
    form();
}

void Accumulating::form()
{
    working_ = cluster_.all() & ~excluded_;
    detectable_remaining_ = instruments_ ? geometry::detectable_instruments_with(cluster_.axes, cluster_.instrument, working_)
                                         : geometry::detectable_with(cluster_.axes, working_);
    blocks_.clear();
    std::array<std::size_t, max_axes> place{};
    place.fill(max_axes);
    geometry::Axes weighted = geometry::Axes::Zero(cluster_.axes.rows(), 3);
    for (std::size_t axis = 0; axis < cluster_.size(); ++axis) {
        if (!has_axis(working_, axis)) continue;
        std::size_t& block = place[cluster_.instrument[axis]];
        if (block == max_axes) {
            block = blocks_.size();
            blocks_.emplace_back();
        }
        blocks_[block].axis[static_cast<std::size_t>(blocks_[block].size++)] = static_cast<Eigen::Index>(axis);
        const auto i = static_cast<Eigen::Index>(axis);
        weighted.row(i) = cluster_.axes.row(i) / variance_(i);
    }
    const Eigen::Matrix3d information = weighted.transpose() * cluster_.axes;
    if (geometry::rank_of(cluster_.axes, working_) == 3) least_squares_ = information.inverse() * weighted.transpose();
    else least_squares_ = decltype(least_squares_)::Zero(3, cluster_.axes.rows());
}

void Accumulating::exclude(AxisMask excluded)
{
    if ((excluded & cluster_.all()) == excluded_) return;
    excluded_ = excluded & cluster_.all();
    form();
}

void Accumulating::reset()
{
    size_ = 0;
    next_ = 0;
    held_out_ = 0;
    alert_ = false;
    previous_rate_.reset();
    previous_acceleration_.setZero();
    wildness_ = 0;
}

bool Accumulating::usable(const Measurement& measurement)
{
    if (held_out_ > 0) --held_out_;
    for (std::size_t axis = 0; axis < cluster_.size(); ++axis) {
        if (!has_axis(working_, axis)) continue;
        if (!has_axis(measurement.valid, axis) || !std::isfinite(measurement.increment[axis])) return false;
        const double range = cluster_.range(static_cast<Eigen::Index>(axis)) * measurement.interval_s;
        if (range > 0 && std::abs(measurement.increment[axis]) > saturation * range) held_out_ = frames_held_out;
    }
    return held_out_ == 0 && measurement.interval_s > 0;
}

void Accumulating::take_in(const Measurement& measurement)
{
    const double h = measurement.interval_s;
    Totals& now = totals_[next_];
    const Totals& before = size_ > 0 ? total(0) : Totals{geometry::AxisVector::Zero(cluster_.axes.rows())};
    geometry::AxisVector z = geometry::AxisVector::Zero(cluster_.axes.rows());
    for (std::size_t axis = 0; axis < cluster_.size(); ++axis)
        if (has_axis(working_, axis)) z(static_cast<Eigen::Index>(axis)) = measurement.increment[axis];
    const Eigen::Vector3d rate = least_squares_ * z / h;
    const Eigen::Vector3d acceleration = previous_rate_ ? Eigen::Vector3d((rate - *previous_rate_) / h) : Eigen::Vector3d::Zero();
    const Eigen::Matrix3d spread =
        (acceleration * acceleration.transpose() + previous_acceleration_ * previous_acceleration_.transpose()) / 2;

    now.angle = before.angle + z;
    // Where the acceleration passes through zero the errors do not: they follow how wild the motion has been lately.
    wildness_ = std::max(acceleration.squaredNorm(), wildness_ + (acceleration.squaredNorm() - wildness_) * calming);
    now.jitter = before.jitter + h * h * spread;
    now.wildness = before.wildness + h * h * wildness_;
    now.rate = rate;
    now.time_s = before.time_s + h;
    now.turned_rad = before.turned_rad + rate.norm() * h;
    now.sequence = measurement.identity.sequence;
    previous_rate_ = rate;
    previous_acceleration_ = acceleration;
    next_ = (next_ + 1) % history_length;
    size_ = std::min(size_ + 1, history_length);
}

Accumulating::Finding Accumulating::examine(std::size_t window) const
{
    const Totals& newest = total(0);
    const Totals& oldest = total(window);
    const geometry::AxisVector z = newest.angle - oldest.angle;
    const Eigen::Matrix3d jitter = newest.jitter - oldest.jitter;
    const Eigen::Vector3d change = newest.rate - oldest.rate;
    const double time_s = newest.time_s - oldest.time_s;
    const double floor = motion_.bias_floor_rad_s * time_s + motion_.rate_error * (newest.turned_rad - oldest.turned_rad);
    const double across = motion_.jitter_across_s * motion_.jitter_across_s;
    const double along = motion_.jitter_along_s * motion_.jitter_along_s;
    const Eigen::Matrix3d motion = (along - across) * jitter + across * (newest.wildness - oldest.wildness) * Eigen::Matrix3d::Identity() +
                                   motion_.lag_s * motion_.lag_s * change * change.transpose();

    // Per instrument: cov^-1 H and cov^-1 z; together the information of the motion.
    std::array<Eigen::Matrix<double, Eigen::Dynamic, 4, Eigen::ColMajor, static_cast<int>(max_axes), 4>, max_axes> weighted;
    std::array<BlockMatrix, max_axes> inverse;
    Eigen::Matrix3d information = Eigen::Matrix3d::Zero();
    Eigen::Vector3d evidence = Eigen::Vector3d::Zero();
    for (std::size_t b = 0; b < blocks_.size(); ++b) {
        const Block& block = blocks_[b];
        Eigen::Matrix<double, Eigen::Dynamic, 4, Eigen::ColMajor, static_cast<int>(max_axes), 4> hz(block.size, 4);
        BlockMatrix covariance(block.size, block.size);
        for (Eigen::Index i = 0; i < block.size; ++i) hz.row(i) << cluster_.axes.row(block.axis[static_cast<std::size_t>(i)]), z(block.axis[static_cast<std::size_t>(i)]);
        covariance.noalias() = hz.leftCols<3>() * motion * hz.leftCols<3>().transpose();
        for (Eigen::Index i = 0; i < block.size; ++i)
            covariance(i, i) += static_cast<double>(window) * variance_(block.axis[static_cast<std::size_t>(i)]) + floor * floor;
        inverse[b] = covariance.inverse();
        weighted[b] = inverse[b] * hz;
        const Eigen::Matrix<double, 3, 4> sums = hz.leftCols<3>().transpose() * weighted[b];
        information += sums.leftCols<3>();
        evidence += sums.col(3);
    }
    const Eigen::Matrix3d covariance = information.inverse();
    const Eigen::Vector3d theta = covariance * evidence;

    Finding finding{.window = window};
    const auto consider = [&](double t, Eigen::Index dof, std::size_t hypothesis) {
        const double certainty = std::sqrt(std::max(0.0, t) / threshold_[static_cast<std::size_t>(dof)]);
        if (certainty > finding.certainty) {
            finding.second = finding.certainty;
            finding.runner_up = finding.best;
            finding.certainty = certainty;
            finding.best = hypothesis;
        } else if (certainty > finding.second) {
            finding.second = certainty;
            finding.runner_up = hypothesis;
        }
    };
    for (std::size_t b = 0; b < blocks_.size(); ++b) {
        const Block& block = blocks_[b];
        const geometry::AxisVector u = weighted[b].col(3) - weighted[b].leftCols<3>() * theta;
        const BlockMatrix q = inverse[b] - weighted[b].leftCols<3>() * covariance * weighted[b].leftCols<3>().transpose();
        if (instruments_) {
            const geometry::AxisVector explained = q.ldlt().solve(u);
            consider(u.dot(explained), block.size, b);
        } else {
            for (Eigen::Index i = 0; i < block.size; ++i)
                consider(u(i) * u(i) / q(i, i), 1, static_cast<std::size_t>(block.axis[static_cast<std::size_t>(i)]));
        }
    }
    return finding;
}

Accumulating::Finding Accumulating::most_certain()
{
    Finding most;
    for (const std::size_t window : windows) {
        if (window >= size_) break;
        if (!alert_ && frames_ % stride_of(window) != 0) continue;
        const Finding finding = examine(window);
        if (finding.certainty > most.certainty) most = finding;
    }
    alert_ = most.certainty > 1;
    return most;
}

AxisMask Accumulating::axes_of(std::size_t hypothesis) const
{
    if (!instruments_) return axis_bit(hypothesis);
    AxisMask axes = 0;
    const Block& block = blocks_[hypothesis];
    for (Eigen::Index i = 0; i < block.size; ++i) axes |= axis_bit(static_cast<std::size_t>(block.axis[static_cast<std::size_t>(i)]));
    return axes;
}

std::uint64_t Accumulating::onset_of(const Finding& finding) const
{
    std::size_t likeliest = finding.window;
    double certainty = finding.certainty;
    const std::size_t shortest = std::max<std::size_t>(1, finding.window / 2);
    const std::size_t longest = std::min({size_ - 1, finding.window * 2, longest_window});
    const std::size_t step = std::max<std::size_t>(1, finding.window / 16);
    for (std::size_t window = shortest; window <= longest; window += step) {
        const Finding other = examine(window);
        if (other.best != finding.best || other.certainty <= certainty) continue;
        certainty = other.certainty;
        likeliest = window;
    }
    return total(likeliest - 1).sequence;
}

void Accumulating::assess(const Measurement& measurement, Assessment& assessment)
{
    assessment = {};
    assessment.outcome = Outcome::healthy;
    assessment.threshold = 1;
    if (!usable(measurement)) {
        previous_rate_.reset();
        assessment.outcome = Outcome::warming_up;  // this frame tells nothing
        return;
    }
    take_in(measurement);
    ++frames_;
    if (size_ < 2 || detectable_remaining_ == 0) return;
    const Finding finding = most_certain();
    assessment.statistic = finding.certainty;
    window_ = finding.window;
    if (finding.certainty > 1) report(finding, assessment);
}

void Accumulating::report(const Finding& finding, Assessment& assessment) const
{
    assessment.onset = onset_of(finding);
    if (finding.certainty >= margin_ * finding.second) {
        assessment.outcome = Outcome::isolated;
        assessment.isolated = axes_of(finding.best);
        return;
    }
    assessment.outcome = Outcome::ambiguous;
    assessment.add_candidate(axes_of(finding.best));
    assessment.add_candidate(axes_of(finding.runner_up));
}

}  // namespace quorient::fdi
