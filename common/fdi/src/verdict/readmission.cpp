#include "verdict/readmission.hpp"

#include "quorient/geometry/redundancy.hpp"

#include <Eigen/Dense>
#include <cmath>

namespace quorient::fdi {
namespace {

/// A healthy residual exceeds this many standard deviations once in a million frames (two-sided normal quantile).
constexpr double agreement_sigmas = 4.892;

/// The sum over a whole trial may reach this many. A healthy axis that fails (one trial in twenty) only waits for the next one, while a
/// weak fault gets a trial after every failure and must lose them all.
constexpr double trial_sigmas = 2;

}  // namespace

Readmission::Readmission(const geometry::SensorCluster& cluster, double healthy_s)
    : cluster_(cluster), healthy_s_(healthy_s), noise_(cluster.axes.rows()), quantisation_(cluster.axes.rows())
{
}

void Readmission::prepare(AxisMask working)
{
    if (working == working_) return;
    working_ = working;
    spans_ = geometry::rank_of(cluster_.axes, working) == 3;
    if (!spans_) return;

    geometry::Axes used = cluster_.axes;
    for (Eigen::Index axis = 0; axis < used.rows(); ++axis)
        if (!has_axis(working, static_cast<std::size_t>(axis))) used.row(axis).setZero();
    const Eigen::Matrix3d information = used.transpose() * used;
    weight_ = cluster_.axes * information.inverse() * used.transpose();
    const geometry::AxisMatrix squared = weight_.cwiseAbs2();
    const geometry::AxisMatrix magnitude = weight_.cwiseAbs();
    noise_ = (cluster_.sigma.cwiseAbs2() + squared * cluster_.sigma.cwiseAbs2()).cwiseSqrt();
    quantisation_ = cluster_.quantum + magnitude * cluster_.quantum;
}

bool Readmission::can_predict(const Measurement& measurement, AxisMask working) const
{
    return spans_ && (measurement.valid & working) == working;
}

double Readmission::predicted(std::size_t axis, const Measurement& measurement) const
{
    double sum = 0;
    for (std::size_t used = 0; used < cluster_.size(); ++used) {
        if (!has_axis(working_, used)) continue;  // an unused axis may be NaN
        sum += weight_(static_cast<Eigen::Index>(axis), static_cast<Eigen::Index>(used)) * measurement.increment[used];
    }
    return sum;
}

void Readmission::excluded(AxisMask newly, const Measurement& measurement, AxisMask working)
{
    prepare(working);
    for (std::size_t axis = 0; axis < cluster_.size(); ++axis) {
        if (!has_axis(newly, axis)) continue;
        trial_[axis] = {};
        trial_[axis].exposed = can_predict(measurement, working) && measurement.interval_s > 0;
        if (trial_[axis].exposed) trial_[axis].excitation = std::abs(predicted(axis, measurement)) / measurement.interval_s;
    }
}

AxisMask Readmission::watch(const Measurement& measurement, AxisMask isolated, AxisMask working)
{
    prepare(working);
    if (!can_predict(measurement, working)) return 0;
    AxisMask returning = 0;
    for (std::size_t axis = 0; axis < cluster_.size(); ++axis) {
        if (!has_axis(isolated, axis) || !trial_[axis].exposed) continue;
        if (serve(trial_[axis], axis, measurement)) returning |= axis_bit(axis);
    }
    return returning;
}

bool Readmission::serve(Trial& trial, std::size_t axis, const Measurement& measurement) const
{
    const auto i = static_cast<Eigen::Index>(axis);
    const double expected = predicted(axis, measurement);
    const double residual = has_axis(measurement.valid, axis) ? measurement.increment[axis] - expected : NAN;
    const bool agrees = std::abs(residual) <= agreement_sigmas * noise_(i) + quantisation_(i);
    if (!agrees || noise_(i) + quantisation_(i) == 0) {
        trial = {.exposed = true, .excitation = trial.excitation};
        return false;
    }
    if (std::abs(expected) < trial.excitation * measurement.interval_s) return false;

    trial.healthy_s += measurement.interval_s;
    trial.frames += 1;
    trial.residual_sum += residual;
    if (trial.healthy_s < healthy_s_) return false;
    // Frames that did not serve lie between those that did, so the carried remainders no longer cancel: they add as noise.
    const double frame_variance = noise_(i) * noise_(i) + quantisation_(i) * quantisation_(i) / 12;
    const bool unbiased = std::abs(trial.residual_sum) <= trial_sigmas * std::sqrt(trial.frames * frame_variance) + quantisation_(i);
    trial = {.exposed = !unbiased, .excitation = trial.excitation};
    return unbiased;
}

}  // namespace quorient::fdi
