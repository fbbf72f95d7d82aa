#include "four_axes/four_axis_detector.hpp"

#include "quorient/fdi/noise.hpp"
#include "quorient/geometry/parity_space.hpp"

#include <Eigen/Dense>
#include <bit>
#include <cmath>

namespace quorient::fdi {
namespace {

constexpr AxisMask four_axes = all_axes(FourAxisDetector::axis_count);

/// Frames further apart than this relative change of interval are not equally spaced any more.
constexpr double interval_tolerance = 0.01;

}  // namespace

auto FourAxisDetector::geometry_of(const DetectorSettings& settings, const geometry::SensorCluster& cluster, std::string_view method)
    -> tl::expected<Geometry, std::string>
{
    const std::string name(method);
    if (cluster.size() != axis_count)
        return tl::unexpected(name + " works on 4 axes, this cluster has " + std::to_string(cluster.size()) +
                              "; use glt, subset or guaranteed");
    if (const auto figures = check_figures(settings); !figures) return tl::unexpected(figures.error());
    const auto pfa = false_alarm_probability(settings);
    if (!pfa) return tl::unexpected(pfa.error());
    const auto triads = geometry::triads(cluster.axes);
    if (triads.size() != axis_count)
        return tl::unexpected(name + ": three of the four axes lie in one plane, so that a fault of the fourth leaves no parity");

    Geometry made;
    for (std::size_t k = 0; k < axis_count; ++k) made.triads[k] = triads[k];
    made.parity_vector = geometry::ParitySpace(cluster.axes).basis().row(0).transpose();
    made.least_squares = (cluster.axes.transpose() * cluster.axes).inverse() * cluster.axes.transpose();
    Eigen::Vector4d sigma = cluster.sigma;
    if (settings.sigma) sigma.setConstant(*settings.sigma);
    made.parity_sigma = made.parity_vector.cwiseProduct(sigma).norm();
    made.parity_quantum = made.parity_vector.cwiseAbs().dot(Eigen::Vector4d(cluster.quantum));
    made.bound = settings.tolerance.value_or(2 * made.parity_quantum + normal_quantile(*pfa / 2) * made.parity_sigma);
    if (!(made.bound > 0))
        return tl::unexpected(name + ": how large a healthy parity may be is not known: state the cluster's sigma or quantum, or a tolerance");
    // Where only a tolerance is known, it stands for twice what quantisation can do.
    if (made.parity_sigma == 0 && made.parity_quantum == 0) made.parity_quantum = made.bound / 2;
    const double regular = made.parity_quantum / made.parity_vector.cwiseAbs().sum();
    made.variance = sigma.cwiseAbs2().array() + regular * regular / 6;
    return made;
}

FourAxisDetector::FourAxisDetector(const Geometry& made)
    : triads_(made.triads), parity_vector_(made.parity_vector), least_squares_(made.least_squares), bound_(made.bound)
{
}

double FourAxisDetector::resolution() const
{
    return bound_ / (2 * parity_vector_.cwiseAbs().sum());
}

void FourAxisDetector::assess(const Measurement& measurement, Assessment& assessment)
{
    assessment = {};
    assessment.threshold = bound_;
    assessment.outcome = Outcome::healthy;
    const AxisMask usable = measurement.usable_of(four_axes & ~excluded_);
    if (std::popcount(usable) < 3) return;  // the next frame finds a gap

    if (!follows(measurement) && !bridge_gap_before(measurement)) start_again();
    started_ = true;
    place_ = StreamPlace::behind(measurement.identity);
    interval_s_ = measurement.interval_s;
    if (holding_) ++held_frames_;
    if (usable == four_axes) {
        judge(frame_of(measurement), assessment);
    } else if (excluded_ != 0) {
        compare_excluded(measurement);
    } else if (holding_) {
        quiet_frames_ = 0;
    } else {
        Frame frame{.identity = measurement.identity};
        for (std::size_t k = 0; k < axis_count; ++k)
            if (triads_[k].mask() == usable) frame.body = triads_[k].body(Eigen::Map<const Eigen::Vector4d>(measurement.increment.data()));
        learn(frame);
    }
}

/// All four are measured, three are used.
void FourAxisDetector::compare_excluded(const Measurement& measurement)
{
    if (measurement.usable_of(four_axes) != four_axes) return;
    const Eigen::Map<const Eigen::Vector4d> z(measurement.increment.data());
    const double parity = parity_vector_.dot(z);
    const auto axis = std::countr_zero(excluded_);
    expected_ = z(axis) - parity / parity_vector_(axis);
    if (std::abs(parity) > bound_) disputed_ = release_frames;
    else if (disputed_ > 0) --disputed_;
}

std::optional<Expectation> FourAxisDetector::expectation(std::size_t axis) const
{
    if (excluded_ != axis_bit(axis)) return std::nullopt;
    return Expectation{.value = expected_, .agrees = disputed_ == 0};
}

bool FourAxisDetector::same_spacing(const Measurement& measurement) const
{
    const bool known = started_ && measurement.identity.epoch == place_.next().epoch;
    return known && std::abs(measurement.interval_s - interval_s_) <= interval_tolerance * interval_s_;
}

bool FourAxisDetector::follows(const Measurement& measurement) const
{
    return same_spacing(measurement) && place_.follows(measurement.identity);
}

bool FourAxisDetector::bridge_gap_before(const Measurement& measurement)
{
    if (!predicts_over_gaps() || !same_spacing(measurement) || learnt() < warm_up_frames) return false;
    const std::uint64_t missing = place_.missing_before(measurement.identity);
    const std::uint64_t held = holding_ ? held_frames_ + missing : missing - 1;  // a hold counts the frames behind its first one
    if (held >= longest_gap) return false;
    held_frames_ = static_cast<unsigned>(held);
    holding_ = true;
    quiet_frames_ = 0;
    return true;
}

FourAxisDetector::Frame FourAxisDetector::frame_of(const Measurement& measurement) const
{
    const Eigen::Map<const Eigen::Vector4d> z(measurement.increment.data());
    Frame frame{.identity = measurement.identity};
    frame.body = least_squares_ * z;
    for (std::size_t k = 0; k < axis_count; ++k) frame.triad_body[k] = triads_[k].body(z);
    frame.parity = parity_vector_.dot(z);
    frame.horizon = holding_ ? held_frames_ + 1 : 1;
    return frame;
}

void FourAxisDetector::judge(const Frame& frame, Assessment& assessment)
{
    assessment.statistic = std::abs(frame.parity);
    for (Eigen::Index axis = 0; axis < 4; ++axis) {  // r = v v'z, healthy while |v'z| <= bound
        assessment.residual[static_cast<std::size_t>(axis)] = parity_vector_(axis) * frame.parity;
        assessment.bound[static_cast<std::size_t>(axis)] = std::abs(parity_vector_(axis)) * bound_;
    }
    observe(frame);
    const bool suspicious = assessment.statistic > bound_;
    // A weak fault comes and goes around the bound: the history is released only when the parity is back at what is regular.
    quiet_frames_ = assessment.statistic > bound_ / 2 ? 0 : quiet_frames_ + 1;
    if (holding_ && quiet_frames_ > 0) quiet_[quiet_frames_ - 1] = frame;
    if (suspicious) judge_suspicion(frame, assessment);
    else if (!holding_) learn(frame);
    else if (quiet_frames_ == release_frames) release();
    if (frames_ < warm_up_frames) {
        ++frames_;
        assessment.outcome = Outcome::warming_up;
    }
}

void FourAxisDetector::judge_suspicion(const Frame& frame, Assessment& assessment)
{
    if (!holding_ && learnt() < warm_up_frames) {
        // A fault is seen, and nothing that was learnt before it shows whose it is.
        assessment.outcome = Outcome::ambiguous;
        for (std::size_t axis = 0; axis < axis_count; ++axis) assessment.add_candidate(axis_bit(axis));
        return start_again();
    }
    if (!holding_) held_frames_ = 0;
    holding_ = true;
    attribute(frame, assessment);
}

void FourAxisDetector::start_again()
{
    holding_ = false;
    forget();
}

/// What is over leaves its quiet frames behind: a fault that begins now finds a history.
void FourAxisDetector::release()
{
    start_again();
    for (const Frame& frame : quiet_) learn(frame);
}

void FourAxisDetector::exclude(AxisMask excluded)
{
    if ((excluded & four_axes) == excluded_) return;
    excluded_ = excluded & four_axes;
    disputed_ = 0;
    reset();
}

void FourAxisDetector::reset()
{
    started_ = false;
    frames_ = 0;
    start_again();
}

}  // namespace quorient::fdi
