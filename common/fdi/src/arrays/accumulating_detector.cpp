#include "arrays/accumulating_detector.hpp"

#include "quorient/fdi/noise.hpp"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <utility>

namespace quorient::fdi {
namespace {

constexpr std::array<std::size_t, AccumulatingDetector::window_count> windows{1,  2,  3,  4,  6,   8,   12,  16,  24,
                                                                      32, 48, 64, 96, 128, 192, 256, 384, AccumulatingDetector::longest_window};

/// A window is looked at this often in its own length: what is in between differs little.
constexpr std::size_t looks_per_window = 8;

/// From this statistic on every window is looked at in every frame.
constexpr double alert_level = 0.7;

/// A window that finds another culprit with at least this certainty counts against the most certain one.
constexpr double contradicting_level = 0.9;

/// Rounds of estimating a step and its beginning by turns.
constexpr int onset_rounds = 6;

/// Gated sums over fewer frames show nothing that the others do not.
constexpr std::size_t shortest_gated = 8;

/// Between two ways to reckon the same.
constexpr double explained_rounding = 1e-6;

constexpr double accumulating_margin = 1.25;
constexpr double default_false_alarms_per_hour = 0.1;

constexpr std::size_t stride_of(std::size_t window)
{
    return std::max<std::size_t>(1, window / looks_per_window);
}

bool is_good(const MotionNoise& noise)
{
    const auto terms = {noise.jitter_along_s, noise.jitter_across_s, noise.roughness_s,
                        noise.axes_error,     noise.rate_error,      noise.bias_floor_rad_s};
    return std::all_of(terms.begin(), terms.end(), [](double term) { return term >= 0 && std::isfinite(term); });
}

/// No outliers; the constant error that calibration left is that of the other sums.
MotionNoise without_outliers(MotionNoise gated, const MotionNoise& other)
{
    gated.roughness_s = 0;
    gated.bias_floor_rad_s = other.bias_floor_rad_s;
    return gated;
}

}  // namespace

tl::expected<std::unique_ptr<AccumulatingDetector>, std::string> AccumulatingDetector::make(const DetectorSettings& settings,
                                                                            const geometry::SensorCluster& cluster)
{
    const double level = settings.motion_noise.value_or(1);
    return make(settings, cluster, cluster.interval_s > 0 ? usual_motion_noise(cluster, level) : MotionNoise{});
}

tl::expected<std::unique_ptr<AccumulatingDetector>, std::string> AccumulatingDetector::make(const DetectorSettings& settings,
                                                                            const geometry::SensorCluster& cluster,
                                                                            const MotionNoise& motion)
{
    if (const auto figures = check_figures(settings); !figures) return tl::unexpected(figures.error());
    if (const auto pfa = false_alarm_probability(settings); !pfa) return tl::unexpected(pfa.error());
    const auto sigma = sigma_of_axes(settings, cluster);
    if (!sigma) return tl::unexpected(sigma.error());
    if (!(cluster.interval_s > 0))
        return tl::unexpected(std::string("accumulating: false alarms are counted per hour, so the cluster's interval_s must be known"));
    const MotionNoise calmer = settings.gated_noise ? without_outliers(*settings.gated_noise, motion) : MotionNoise{};
    if (!is_good(motion) || !is_good(calmer))
        return tl::unexpected(std::string("accumulating: the terms of the motion noise must be finite and at least 0"));
    auto array = InstrumentArray::make(cluster, sigma->cwiseAbs2());
    if (!array) return tl::unexpected("accumulating: " + array.error());
    std::optional<ArraySums> gated;
    if (settings.gated_noise) gated.emplace(*array, calmer, chi_square_quantile(3, ArraySums::gate_tail));
    return std::unique_ptr<AccumulatingDetector>(new AccumulatingDetector(settings, cluster, ArraySums(*array, motion), std::move(gated)));
}

AccumulatingDetector::AccumulatingDetector(const DetectorSettings& settings, const geometry::SensorCluster& cluster, ArraySums sums,
                           std::optional<ArraySums> gated)
    : sums_(std::move(sums)),
      gated_(std::move(gated)),
      all_(cluster.all()),
      instruments_alone_(settings.instruments),
      margin_(settings.margin.value_or(accumulating_margin))
{
    const double frames_per_hour = 3600 / cluster.interval_s;
    false_alarms_per_hour_ = settings.pfa ? *settings.pfa * frames_per_hour : default_false_alarms_per_hour;
    const auto gated_count = gated_ ? std::count_if(windows.begin(), windows.end(), [](std::size_t w) { return w >= shortest_gated; }) : 0;
    const double tried = static_cast<double>(windows.size()) + static_cast<double>(gated_count);
    const double hypotheses = static_cast<double>(cluster.size()) * 4 / 3;  // every axis, and every instrument
    for (std::size_t i = 0; i < windows.size(); ++i) {
        const double looks_per_hour = frames_per_hour / static_cast<double>(stride_of(windows[i]));
        const double share = false_alarms_per_hour_ / tried;
        const double tail = std::min(0.5, share / (looks_per_hour * hypotheses));
        limits_[i] = {.axis = chi_square_quantile(1, tail), .instrument = chi_square_quantile(3, tail)};
    }
}

unsigned AccumulatingDetector::detectable_remaining() const
{
    return sums_.array().compared_count() >= 2 ? 1 : 0;
}

void AccumulatingDetector::exclude(AxisMask excluded)
{
    if ((excluded & all_) == excluded_) return;
    excluded_ = excluded & all_;
    sums_.exclude(excluded_);
    if (gated_) gated_->exclude(excluded_);
}

void AccumulatingDetector::reset()
{
    sums_.reset();
    if (gated_) gated_->reset();
    alert_ = false;
}

/// No hypothesis reaches a higher certainty over this window: none explains more than its whole instrument, and an axis is the cheapest.
double AccumulatingDetector::most_possible(std::size_t window, const Limits& limits) const
{
    double largest = sums_.largest_chi_square(window);
    if (gated_ && window >= shortest_gated) largest = std::max(largest, gated_->largest_chi_square(window));
    return std::sqrt(largest * (1 + explained_rounding) / limits.axis);
}

AccumulatingDetector::Finding AccumulatingDetector::examine(const ArraySums& sums, std::size_t window, const Limits& limits) const
{
    const ArraySums::Fit fit = sums.fit(window);
    Finding finding;
    finding.window = window;
    for (std::size_t m = 0; m < sums_.array().size(); ++m)
        if (sums_.array().compared(m)) weigh(m, fit, limits, finding);
    return finding;
}

AccumulatingDetector::Finding AccumulatingDetector::examine(std::size_t window, const Limits& limits) const
{
    const Finding usual = examine(sums_, window, limits);
    if (!gated_ || window < shortest_gated) return usual;
    const Finding gated = examine(*gated_, window, limits);
    return gated.certainty > usual.certainty ? gated : usual;
}

void AccumulatingDetector::Finding::consider(double with_certainty, AxisMask axes, const Hypothesis& what)
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

void AccumulatingDetector::weigh(std::size_t place, const ArraySums::Fit& fit, const Limits& limits, Finding& finding) const
{
    const InstrumentArray::Instrument& instrument = sums_.array()[place];
    const double most_explained = fit.chi_square(place);
    // No axis explains more than the whole instrument: where even that is less than what is known, nothing changes.
    if (most_explained * (1 + explained_rounding) < limits.axis * finding.second * finding.second) return;
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
    const double whole = std::sqrt(most_explained / limits.instrument);
    if (whole > most) likeliest.axis.reset();
    finding.consider(std::max(most, whole), instrument.mask, likeliest);
}

AccumulatingDetector::Finding AccumulatingDetector::most_certain()
{
    std::array<double, window_count> possible{};
    for (std::size_t i = 0; i < windows.size() && windows[i] < sums_.size(); ++i)
        if (alert_ || sums_.counted() % stride_of(windows[i]) == 0) possible[i] = most_possible(windows[i], limits_[i]);
    const auto likeliest = static_cast<std::size_t>(std::max_element(possible.begin(), possible.end()) - possible.begin());
    Finding most = examine(windows[likeliest], limits_[likeliest]);
    std::array<Finding, window_count> findings;
    findings[likeliest] = most;
    for (std::size_t i = 0; i < windows.size(); ++i) {
        // Neither the most certain window nor one that contradicts it.
        if (i == likeliest || possible[i] <= std::min(most.certainty, contradicting_level)) continue;
        findings[i] = examine(windows[i], limits_[i]);
        if (findings[i].certainty > most.certainty) most = findings[i];
    }
    // A window that is suspicious of somebody else is a rival as much as the second one in this window.
    for (const Finding& other : findings)
        if (other.certainty > contradicting_level && other.best != most.best && other.certainty > most.second) {
            most.second = other.certainty;
            most.runner_up = other.best;
        }
    alert_ = most.certainty > alert_level;
    return most;
}

/// The constant error of the body vector, per frame, that explains the window best: E u = Q W step.
Eigen::Vector3d AccumulatingDetector::step_over(std::size_t window, const Hypothesis& hypothesis) const
{
    const ArraySums::Fit fit = sums_.fit(window);
    const auto [u, q] = fit.contradiction(hypothesis.instrument);
    if (!hypothesis.axis) return fit.weight.inverse() * q.inverse() * u;
    const InstrumentArray::Instrument& instrument = sums_.array()[hypothesis.instrument];
    const Eigen::Vector3d axis = instrument.body_from_axes.col(static_cast<Eigen::Index>(*hypothesis.axis));
    const Eigen::Vector3d direction = fit.weight * axis;
    return axis * (direction.dot(u) / direction.dot(q * direction));
}

/// Logarithm, against no step at all.
double AccumulatingDetector::likelihood(const Eigen::Vector3d& step, std::size_t window, const Hypothesis& hypothesis) const
{
    const ArraySums::Fit fit = sums_.fit(window);
    const auto [u, q] = fit.contradiction(hypothesis.instrument);
    const Eigen::Vector3d error = fit.weight * step;
    return error.dot(u) - error.dot(q * error) / 2;
}

std::size_t AccumulatingDetector::likeliest_window(const Eigen::Vector3d& step, const Hypothesis& hypothesis) const
{
    std::size_t likeliest = 1;
    double most = likelihood(step, 1, hypothesis);
    const auto consider = [&](std::size_t window) {
        const double value = likelihood(step, window, hypothesis);
        if (value <= most) return;
        most = value;
        likeliest = window;
    };
    const std::size_t longest = std::min(sums_.size() - 1, longest_window);
    for (std::size_t window = 2; window <= longest; window += 1 + window / 16) consider(window);
    const std::size_t around = likeliest / 16;
    for (std::size_t window = likeliest - around; window <= std::min(longest, likeliest + around); ++window) consider(window);
    return likeliest;
}

std::uint64_t AccumulatingDetector::onset_of(const Finding& finding) const
{
    std::size_t window = finding.window;
    for (int round = 0; round < onset_rounds; ++round) {
        const std::size_t before = window;
        window = likeliest_window(step_over(window, finding.hypothesis), finding.hypothesis);
        if (window == before) break;
    }
    return sums_.begin_of(window);
}

void AccumulatingDetector::assess(const Measurement& measurement, Assessment& assessment)
{
    assessment = {};
    assessment.outcome = Outcome::healthy;
    assessment.threshold = 1;
    if (detectable_remaining() == 0) return;
    const ArraySums::Added added = sums_.add(measurement);
    if (gated_) gated_->add(measurement);
    if (added == ArraySums::Added::unusable) assessment.outcome = Outcome::warming_up;  // this frame shows nothing
    if (added != ArraySums::Added::counted || sums_.size() < 2) return;

    const Finding finding = most_certain();
    assessment.statistic = finding.certainty;
    window_ = finding.window;
    if (finding.certainty > 1) report(finding, assessment);
}

void AccumulatingDetector::report(const Finding& finding, Assessment& assessment) const
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
