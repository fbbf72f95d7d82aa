#include "quorient/fdi/accumulating.hpp"

#include "quorient/fdi/noise.hpp"
#include "quorient/geometry/redundancy.hpp"

#include <Eigen/Dense>
#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>

namespace quorient::fdi {
namespace {

constexpr std::array<std::size_t, Accumulating::window_count> windows{1,  2,  3,  4,  6,   8,   12,  16,  24,
                                                                      32, 48, 64, 96, 128, 192, 256, 384, Accumulating::longest_window};

/// A window is looked at this often in its own length: what is in between differs little.
constexpr std::size_t looks_per_window = 8;

/// An axis this close to its range may be beyond it …
constexpr double saturation = 0.975;

/// … by a standard deviation of this times its range.
constexpr double excess = 0.5;

/// From this statistic on every window is looked at in every frame.
constexpr double alert_level = 0.7;

/// Rounds of estimating a step and its beginning by turns.
constexpr int onset_rounds = 6;

/// A blow: in the frame in which a motion begins the acceleration is larger than its mean over the frame shows, its square by up to
/// this (and one). Bounds the knocks between the poses of the MIMU4444 recordings.
constexpr double blow_excess = 16;

/// How fast the memory of a wild moment fades, per frame.
constexpr double calming = 1.0 / 16;

/// Share of the roughness that lowers a frame's weight: most frames are not the outliers that it stands for.
constexpr double roughness_in_weight = 0.03;

constexpr double default_margin = 1.25;
constexpr double default_false_alarms_per_hour = 0.1;

constexpr std::size_t stride_of(std::size_t window)
{
    return std::max<std::size_t>(1, window / looks_per_window);
}

}  // namespace

MotionNoise usual_motion_noise(const geometry::SensorCluster& cluster)
{
    const double rate_sigma = std::sqrt((cluster.sigma.cwiseAbs2() + cluster.quantum.cwiseAbs2() / 6).mean()) / cluster.interval_s;
    return {.jitter_along_s = 0.0084 * cluster.interval_s,
            .jitter_across_s = 0.0046 * cluster.interval_s,
            .roughness_s = 0.028 * cluster.interval_s,
            .axes_error = 6e-4,
            .rate_error = 1e-4,
            .bias_floor_rad_s = 0.16 * rate_sigma};
}

tl::expected<std::unique_ptr<Accumulating>, std::string> Accumulating::make(const DetectorSettings& settings,
                                                                            const geometry::SensorCluster& cluster)
{
    return make(settings, cluster, cluster.interval_s > 0 ? usual_motion_noise(cluster) : MotionNoise{});
}

tl::expected<std::unique_ptr<Accumulating>, std::string> Accumulating::make(const DetectorSettings& settings,
                                                                            const geometry::SensorCluster& cluster,
                                                                            const MotionNoise& motion)
{
    if (const auto figures = check_figures(settings); !figures) return tl::unexpected(figures.error());
    if (const auto pfa = false_alarm_probability(settings); !pfa) return tl::unexpected(pfa.error());
    if (const auto sigma = sigma_of_axes(settings, cluster); !sigma) return tl::unexpected(sigma.error());
    if (!(cluster.interval_s > 0))
        return tl::unexpected(std::string("accumulating: false alarms are counted per hour, so the cluster's interval_s must be known"));
    for (const double figure :
         {motion.jitter_along_s, motion.jitter_across_s, motion.roughness_s, motion.axes_error, motion.rate_error, motion.bias_floor_rad_s})
        if (!(figure >= 0 && std::isfinite(figure)))
            return tl::unexpected(std::string("accumulating: the terms of the motion noise must be finite and at least 0"));
    std::unique_ptr<Accumulating> made(new Accumulating(settings, cluster, motion));
    if (const std::string problem = made->form_instruments(); !problem.empty()) return tl::unexpected("accumulating: " + problem);
    return made;
}

Accumulating::Accumulating(const DetectorSettings& settings, const geometry::SensorCluster& cluster, const MotionNoise& motion)
    : cluster_(cluster),
      variance_(sigma_of_axes(settings, cluster)->cwiseAbs2()),
      motion_(motion),
      instruments_alone_(settings.instruments),
      margin_(settings.margin.value_or(default_margin)),
      totals_(history_length)
{
    const double frames_per_hour = 3600 / cluster.interval_s;
    false_alarms_per_hour_ = settings.pfa ? *settings.pfa * frames_per_hour : default_false_alarms_per_hour;
    const double hypotheses = static_cast<double>(cluster.size()) * 4 / 3;  // every axis, and every instrument
    for (std::size_t i = 0; i < windows.size(); ++i) {
        const double looks_per_hour = frames_per_hour / static_cast<double>(stride_of(windows[i]));
        const double share = false_alarms_per_hour_ / static_cast<double>(windows.size());
        const double tail = std::min(0.5, share / (looks_per_hour * hypotheses));
        limits_[i] = {.axis = chi_square_quantile(1, tail), .instrument = chi_square_quantile(3, tail)};
    }
}

std::string Accumulating::form_instruments()
{
    const std::size_t count = 1 + *std::max_element(cluster_.instrument.begin(), cluster_.instrument.end());
    instruments_.resize(count);
    for (std::size_t axis = 0; axis < cluster_.size(); ++axis) {
        Instrument& instrument = instruments_[cluster_.instrument[axis]];
        instrument.axis[instrument.size++] = axis;
        instrument.mask |= axis_bit(axis);
    }
    std::erase_if(instruments_, [](const Instrument& instrument) { return instrument.size == 0; });
    if (instruments_.size() < 2) return "needs two or more instruments, this cluster has one";
    mean_covariance_.setZero();
    for (Instrument& instrument : instruments_) {
        if (geometry::rank_of(cluster_.axes, instrument.mask) < 3)
            return "compares instruments that each measure all three directions; these axes do not: use glt or subset";
        const auto n = static_cast<Eigen::Index>(instrument.size);
        Eigen::Matrix<double, 3, Eigen::Dynamic, Eigen::ColMajor, 3, static_cast<int>(max_axes)> weighted(3, n);
        Eigen::Matrix3d information = Eigen::Matrix3d::Zero();
        for (Eigen::Index i = 0; i < n; ++i) {
            const auto axis = static_cast<Eigen::Index>(instrument.axis[static_cast<std::size_t>(i)]);
            weighted.col(i) = cluster_.axes.row(axis).transpose() / variance_(axis);
            information += weighted.col(i) * cluster_.axes.row(axis);
        }
        instrument.covariance = information.inverse();
        instrument.body_from_axes = instrument.covariance * weighted;
        mean_covariance_ += instrument.covariance / static_cast<double>(instruments_.size());
    }
    mean_information_ = mean_covariance_.inverse();
    scale_ = 3 / mean_information_.trace();
    for (Totals& totals : totals_) totals.sum.setZero(3, static_cast<Eigen::Index>(instruments_.size()));
    return {};
}

unsigned Accumulating::detectable_remaining() const
{
    const auto left = std::count_if(instruments_.begin(), instruments_.end(), [this](const Instrument& i) { return compared(i); });
    return left >= 2 ? 1 : 0;
}

void Accumulating::exclude(AxisMask excluded)
{
    if ((excluded & cluster_.all()) == excluded_) return;
    excluded_ = excluded & cluster_.all();
    pending_.reset();
}

void Accumulating::reset()
{
    size_ = 0;
    near_range_ = 0;
    near_range_before_ = 0;
    alert_ = false;
    wildness_ = 0;
    pending_.reset();
}

bool Accumulating::usable(const Measurement& measurement)
{
    near_range_before_ = near_range_;
    near_range_ = 0;
    for (const Instrument& instrument : instruments_) {
        if (!compared(instrument)) continue;
        for (std::size_t i = 0; i < instrument.size; ++i) {
            const std::size_t axis = instrument.axis[i];
            if (!has_axis(measurement.valid, axis) || !std::isfinite(measurement.increment[axis])) return false;
            const double range = cluster_.range(static_cast<Eigen::Index>(axis)) * measurement.interval_s;
            if (range > 0 && std::abs(measurement.increment[axis]) > saturation * range) near_range_ |= axis_bit(axis);
        }
    }
    return measurement.interval_s > 0;
}

Accumulating::Pending Accumulating::pending_of(const Measurement& measurement) const
{
    Pending frame;
    frame.sequence = measurement.identity.sequence;
    frame.interval_s = measurement.interval_s;
    frame.saturated = near_range_ | near_range_before_;
    frame.body.setZero(3, static_cast<Eigen::Index>(instruments_.size()));
    double left = 0;
    for (std::size_t m = 0; m < instruments_.size(); ++m) {
        const Instrument& instrument = instruments_[m];
        if (!compared(instrument)) continue;
        auto body = frame.body.col(static_cast<Eigen::Index>(m));
        for (std::size_t i = 0; i < instrument.size; ++i)
            body += instrument.body_from_axes.col(static_cast<Eigen::Index>(i)) * measurement.increment[instrument.axis[i]];
        frame.rate += body / measurement.interval_s;
        left += 1;
    }
    frame.rate /= left;
    return frame;
}

Eigen::Matrix3d Accumulating::blindness(AxisMask saturated, double interval_s) const
{
    Eigen::Matrix3d blind = Eigen::Matrix3d::Zero();
    for (const Instrument& instrument : instruments_) {
        if (!compared(instrument) || (instrument.mask & saturated) == 0) continue;
        for (std::size_t i = 0; i < instrument.size; ++i) {
            if (!has_axis(saturated, instrument.axis[i])) continue;
            const double unknown = excess * cluster_.range(static_cast<Eigen::Index>(instrument.axis[i])) * interval_s;
            const Eigen::Vector3d along = unknown * instrument.body_from_axes.col(static_cast<Eigen::Index>(i));
            blind += along * along.transpose();
        }
    }
    return blind;
}

Eigen::Matrix3d Accumulating::motion_covariance(const Pending& frame, const Eigen::Vector3d& acceleration_after, double blow,
                                                double rough) const
{
    const Eigen::Vector3d& a = frame.acceleration_before;
    const Eigen::Vector3d& b = acceleration_after;
    const double h = frame.interval_s;
    const double along = motion_.jitter_along_s * motion_.jitter_along_s;
    const double across = motion_.jitter_across_s * motion_.jitter_across_s;
    const Eigen::Matrix3d spread = h * h * (a * a.transpose() + b * b.transpose()) / 2;
    const double outliers = roughness_in_weight * motion_.roughness_s * motion_.roughness_s * rough;
    return blow * (along - across) * spread + (blow * across * spread.trace() + outliers) * Eigen::Matrix3d::Identity();
}

void Accumulating::take_in(const Pending& frame, const Eigen::Vector3d& acceleration_after)
{
    const double h = frame.interval_s;
    const double squared = std::max(frame.acceleration_before.squaredNorm(), acceleration_after.squaredNorm());
    const double blow = squared > wildness_ ? 1 + blow_excess * (1 - wildness_ / squared) : 1;
    // Where the acceleration passes through zero the errors do not: they follow how wild the motion has been lately.
    wildness_ = std::max(squared * blow, wildness_ + (squared - wildness_) * calming);
    const double rough = h * h * wildness_;
    const Eigen::Matrix3d moving = motion_covariance(frame, acceleration_after, blow, rough) + blindness(frame.saturated, h);
    const Eigen::Matrix3d weight = scale_ * (mean_covariance_ + moving).inverse();
    const double largest = Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>().computeDirect(weight, Eigen::EigenvaluesOnly).eigenvalues()(2);
    const double resting = weight.trace() / 3;

    const Totals& before = total(0);
    Totals& now = totals_[next_];
    now.sum = before.sum + weight * frame.body;
    now.weight = before.weight + weight;
    now.biased = before.biased + weight * h;
    now.turned = before.turned + weight * (frame.rate.norm() * h);
    for (Eigen::Index axis = 0; axis < 3; ++axis) {
        const auto j = static_cast<std::size_t>(axis);
        now.rotated[j] = before.rotated[j] + weight * (frame.rate(axis) * h);
    }
    now.rest = before.rest + resting * resting;
    now.roughness = largest * largest * rough;
    now.sequence = frame.sequence;
    next_ = (next_ + 1) % history_length;
    size_ = std::min(size_ + 1, history_length);
    ++frames_;
}

Eigen::Matrix3d Accumulating::common_covariance(std::size_t window) const
{
    const Totals& newest = total(0);
    const Totals& oldest = total(window);
    const Eigen::Matrix3d constant =
        motion_.bias_floor_rad_s * (newest.biased - oldest.biased) + motion_.rate_error * (newest.turned - oldest.turned);
    double roughest = 0;
    for (std::size_t age = 0; age < window; ++age) roughest = std::max(roughest, total(age).roughness);
    const double outlier = motion_.roughness_s * motion_.roughness_s * roughest;
    Eigen::Matrix3d floors = constant * constant.transpose();
    for (std::size_t j = 0; j < 3; ++j) {
        const Eigen::Matrix3d rotated = motion_.axes_error * (newest.rotated[j] - oldest.rotated[j]);
        floors += rotated * rotated.transpose();
    }
    return scale_ * (newest.weight - oldest.weight) + floors + outlier * Eigen::Matrix3d::Identity();
}

Accumulating::Contradiction Accumulating::Fit::contradiction(std::size_t instrument) const
{
    const Eigen::Matrix3d& own = information[instrument];
    return {.u = own * (value[instrument] - fused), .q = own - own * covariance * own};
}

Accumulating::Fit Accumulating::fit(std::size_t window) const
{
    const Totals& newest = total(0);
    const Totals& oldest = total(window);
    const Eigen::Matrix3d common = common_covariance(window);
    const double rest = scale_ * scale_ * (newest.rest - oldest.rest);

    Fit fit;
    fit.weight = newest.weight - oldest.weight;
    Eigen::Matrix3d total_information = Eigen::Matrix3d::Zero();
    Eigen::Vector3d total_value = Eigen::Vector3d::Zero();
    for (std::size_t m = 0; m < instruments_.size(); ++m) {
        if (!compared(instruments_[m])) continue;
        const auto column = static_cast<Eigen::Index>(m);
        const Eigen::Matrix3d own = mean_information_ * (instruments_[m].covariance - mean_covariance_) * mean_information_;
        fit.value[m] = newest.sum.col(column) - oldest.sum.col(column);
        fit.information[m] = (common + rest * own).inverse();
        total_information += fit.information[m];
        total_value += fit.information[m] * fit.value[m];
    }
    fit.covariance = total_information.inverse();
    fit.fused = fit.covariance * total_value;
    return fit;
}

Accumulating::Finding Accumulating::examine(std::size_t window, const Limits& limits) const
{
    const Fit windows_fit = fit(window);
    Finding finding;
    finding.window = window;
    for (std::size_t m = 0; m < instruments_.size(); ++m)
        if (compared(instruments_[m])) weigh(m, windows_fit, limits, finding);
    return finding;
}

void Accumulating::Finding::consider(double with_certainty, AxisMask axes, const Hypothesis& what)
{
    if (with_certainty > certainty) {
        second = certainty;
        runner_up = best;
        certainty = with_certainty;
        best = axes;
        hypothesis = what;
    } else if (with_certainty > second) {
        second = with_certainty;
        runner_up = axes;
    }
}

void Accumulating::weigh(std::size_t place, const Fit& fit, const Limits& limits, Finding& finding) const
{
    const Instrument& instrument = instruments_[place];
    const auto [u, q] = fit.contradiction(place);
    double most = 0;
    Hypothesis likeliest{.instrument = place};
    for (std::size_t i = 0; i < instrument.size; ++i) {
        const Eigen::Vector3d direction = fit.weight * instrument.body_from_axes.col(static_cast<Eigen::Index>(i));
        const double explained = std::pow(direction.dot(u), 2) / direction.dot(q * direction);
        const double certainty = std::sqrt(explained / limits.axis);
        const Hypothesis axis{.instrument = place, .axis = i};
        if (!instruments_alone_) finding.consider(certainty, axis_bit(instrument.axis[i]), axis);
        if (certainty <= most) continue;
        most = certainty;
        likeliest = axis;
    }
    if (!instruments_alone_) return;
    const double whole = std::sqrt(std::max(0.0, u.dot(q.inverse() * u)) / limits.instrument);
    if (whole > most) likeliest.axis.reset();
    finding.consider(std::max(most, whole), instrument.mask, likeliest);
}

Accumulating::Finding Accumulating::most_certain()
{
    Finding most;
    for (std::size_t i = 0; i < windows.size() && windows[i] < size_; ++i) {
        if (!alert_ && frames_ % stride_of(windows[i]) != 0) continue;
        const Finding finding = examine(windows[i], limits_[i]);
        if (finding.certainty > most.certainty) most = finding;
    }
    alert_ = most.certainty > alert_level;
    return most;
}

/// The constant error of the body vector, per frame, that explains the window best: E u = Q W step.
Eigen::Vector3d Accumulating::step_over(std::size_t window, const Hypothesis& hypothesis) const
{
    const Fit windows_fit = fit(window);
    const auto [u, q] = windows_fit.contradiction(hypothesis.instrument);
    if (!hypothesis.axis) return windows_fit.weight.inverse() * q.inverse() * u;
    const Eigen::Vector3d axis = instruments_[hypothesis.instrument].body_from_axes.col(static_cast<Eigen::Index>(*hypothesis.axis));
    const Eigen::Vector3d direction = windows_fit.weight * axis;
    return axis * (direction.dot(u) / direction.dot(q * direction));
}

/// Logarithm, against no step at all.
double Accumulating::likelihood(const Eigen::Vector3d& step, std::size_t window, const Hypothesis& hypothesis) const
{
    const Fit windows_fit = fit(window);
    const auto [u, q] = windows_fit.contradiction(hypothesis.instrument);
    const Eigen::Vector3d error = windows_fit.weight * step;
    return error.dot(u) - error.dot(q * error) / 2;
}

std::size_t Accumulating::likeliest_window(const Eigen::Vector3d& step, const Hypothesis& hypothesis) const
{
    std::size_t likeliest = 1;
    double most = likelihood(step, 1, hypothesis);
    const auto consider = [&](std::size_t window) {
        const double value = likelihood(step, window, hypothesis);
        if (value <= most) return;
        most = value;
        likeliest = window;
    };
    const std::size_t longest = std::min(size_ - 1, longest_window);
    for (std::size_t window = 2; window <= longest; window += 1 + window / 16) consider(window);
    const std::size_t around = likeliest / 16;
    for (std::size_t window = likeliest - around; window <= std::min(longest, likeliest + around); ++window) consider(window);
    return likeliest;
}

std::uint64_t Accumulating::onset_of(const Finding& finding) const
{
    std::size_t window = finding.window;
    for (int round = 0; round < onset_rounds; ++round) {
        const std::size_t before = window;
        window = likeliest_window(step_over(window, finding.hypothesis), finding.hypothesis);
        if (window == before) break;
    }
    return total(window - 1).sequence;
}

void Accumulating::assess(const Measurement& measurement, Assessment& assessment)
{
    assessment = {};
    assessment.outcome = Outcome::healthy;
    assessment.threshold = 1;
    if (detectable_remaining() == 0) return;
    if (!usable(measurement)) {
        pending_.reset();
        assessment.outcome = Outcome::warming_up;  // this frame tells nothing
        return;
    }
    Pending newest = pending_of(measurement);
    const bool followed = pending_.has_value();
    if (followed) {
        newest.acceleration_before = (newest.rate - pending_->rate) / measurement.interval_s;
        take_in(*pending_, newest.acceleration_before);
    }
    pending_ = newest;
    if (size_ < 2 || !followed) return;

    const Finding finding = most_certain();
    assessment.statistic = finding.certainty;
    window_ = finding.window;
    if (finding.certainty > 1) report(finding, assessment);
}

void Accumulating::report(const Finding& finding, Assessment& assessment) const
{
    assessment.onset = onset_of(finding);
    assessment.add_candidate(finding.best);
    if (finding.certainty >= margin_ * finding.second) {
        assessment.outcome = Outcome::isolated;
        assessment.isolated = finding.best;
        return;
    }
    assessment.outcome = Outcome::ambiguous;
    assessment.add_candidate(finding.runner_up);
}

}  // namespace quorient::fdi
