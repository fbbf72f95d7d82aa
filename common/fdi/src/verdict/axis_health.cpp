#include "verdict/axis_health.hpp"

#include "quorient/geometry/redundancy.hpp"

#include <Eigen/Dense>
#include <algorithm>
#include <bit>
#include <cmath>

namespace quorient::fdi {
namespace {

constexpr int absent_of_32 = 8;
constexpr double beyond_range = 1.02;
constexpr double near_range = 0.975;
constexpr double others_range = 0.8;
constexpr double moving_sigmas = 6;
constexpr unsigned repeats_while_it_should_move = 2;

/// ln 1e-9, the chance of a run of repeats that is taken for a frozen axis at rest.
constexpr double improbable_run = -20.7;

/// A habit is known from at least this many frames, and follows the last few thousand.
constexpr double habit_frames = 200;
constexpr double habit_memory = 4096;

bool present(const Measurement& measurement, std::size_t axis)
{
    return has_axis(measurement.valid, axis) && std::isfinite(measurement.increment[axis]);
}

/// Whether the other axes, without those of one further instrument, see this one at its range after all: then that instrument may be the
/// faulty one, whose error the prediction from all of them shares.
bool is_borne_out(const geometry::SensorCluster& cluster, const Measurement& measurement, std::size_t axis, double least)
{
    constexpr double least_determinant = 1e-3;
    const std::size_t last = *std::max_element(cluster.instrument.begin(), cluster.instrument.end());
    for (std::size_t left_out = 0; left_out <= last; ++left_out) {
        if (left_out == cluster.instrument[axis]) continue;
        Eigen::Matrix3d information = Eigen::Matrix3d::Zero();
        Eigen::Vector3d sum = Eigen::Vector3d::Zero();
        for (std::size_t other = 0; other < cluster.size(); ++other) {
            if (other == axis || cluster.instrument[other] == left_out || !present(measurement, other)) continue;
            const auto row = cluster.axes.row(static_cast<Eigen::Index>(other));
            information += row.transpose() * row;
            sum += row.transpose() * measurement.increment[other];
        }
        if (information.determinant() < least_determinant) continue;
        const double seen = cluster.axes.row(static_cast<Eigen::Index>(axis)).dot(information.inverse() * sum);
        if (std::abs(seen) >= least) return true;
    }
    return false;
}

}  // namespace

AxisHealth::AxisHealth(const geometry::SensorCluster& cluster) : cluster_(cluster), space_(cluster.axes), moving_step_(cluster.axes.rows())
{
    for (std::size_t axis = 0; axis < cluster.size(); ++axis) {
        const auto i = static_cast<Eigen::Index>(axis);
        moving_step_(i) = moving_sigmas * std::sqrt(2 * cluster.sigma(i) * cluster.sigma(i) + cluster.quantum(i) * cluster.quantum(i) / 3);
        if (cluster.sigma(i) > 0 && cluster.sigma(i) >= cluster.quantum(i) / 4) noisy_ |= axis_bit(axis);
    }
    work_with(cluster.all());
}

void AxisHealth::reset()
{
    history_.fill({});
    fault_.fill(AxisFault::none);
    moving_.fill(false);
    broken_ = 0;
}

AxisMask AxisHealth::assess(const Measurement& measurement)
{
    predict(measurement);
    broken_ = 0;
    for (std::size_t axis = 0; axis < cluster_.size(); ++axis) {
        remember(measurement, axis);
        fault_[axis] = judge(measurement, axis);
        if (fault_[axis] != AxisFault::none) broken_ |= axis_bit(axis);
    }
    return broken_;
}

void AxisHealth::predict(const Measurement& measurement)
{
    AxisMask used = 0;
    geometry::AxisVector z = geometry::AxisVector::Zero(cluster_.axes.rows());
    for (std::size_t axis = 0; axis < cluster_.size(); ++axis) {
        if (!present(measurement, axis) || has_axis(broken_, axis)) continue;  // what was just broken does not speak for others
        z(static_cast<Eigen::Index>(axis)) = measurement.increment[axis];
        used |= axis_bit(axis);
    }
    if (used != space_.used()) work_with(used);
    const geometry::AxisVector parity = space_.vector(z);
    const Eigen::Vector3d body = least_squares_ * z;
    for (std::size_t axis = 0; axis < cluster_.size(); ++axis) {
        const auto i = static_cast<Eigen::Index>(axis);
        History& history = history_[axis];
        const bool outside = !has_axis(used, axis);
        const bool known = outside ? spans_ : space_.sees(i);
        double predicted = 0;
        if (known) predicted = outside ? cluster_.axes.row(i).dot(body) : z(i) - space_.fault_estimate(i, parity);
        moving_[axis] = known && history.is_predicted && std::abs(predicted - history.predicted) > moving_step_(i);
        history.predicted = predicted;
        history.is_predicted = known;
    }
}

void AxisHealth::work_with(AxisMask used)
{
    space_ = geometry::ParitySpace(cluster_.axes, used);
    spans_ = geometry::rank_of(cluster_.axes, used) == 3;
    geometry::Axes axes = cluster_.axes;
    for (Eigen::Index axis = 0; axis < axes.rows(); ++axis)
        if (!has_axis(used, static_cast<std::size_t>(axis))) axes.row(axis).setZero();
    least_squares_ = decltype(least_squares_)::Zero(3, axes.rows());
    if (spans_) least_squares_ = (axes.transpose() * axes).inverse() * axes.transpose();
}

void AxisHealth::remember(const Measurement& measurement, std::size_t axis)
{
    History& history = history_[axis];
    const bool here = present(measurement, axis);
    history.absent_frames = (history.absent_frames << 1) | (here ? 0U : 1U);
    if (!here) return;

    const double value = measurement.increment[axis];
    // Beyond its range a sound axis repeats its limit as long as the motion stays there: is_railed judges that.
    const bool repeat = history.known && !is_near_range(measurement, axis) &&
                        std::bit_cast<std::uint64_t>(value) == std::bit_cast<std::uint64_t>(history.last);
    if (repeat) {
        ++history.repeats;
        // Around a turning point an axis may truly come back to the value it had: then the others agree with it, and it lives.
        const bool contradicted = std::abs(value - history.predicted) > moving_step_(static_cast<Eigen::Index>(axis));
        if (moving_[axis]) history.repeats_in_motion = contradicted ? history.repeats_in_motion + 1 : 0;
    } else {
        // The run that has ended joins the habit; one that goes on might be a fault and does not.
        history.seen += history.repeats + 1;
        history.repeated += history.repeats;
        history.repeats = 0;
        history.repeats_in_motion = 0;
    }
    if (history.seen > habit_memory) {
        history.seen /= 2;
        history.repeated /= 2;
    }
    history.last = value;
    history.known = true;
}

AxisFault AxisHealth::judge(const Measurement& measurement, std::size_t axis) const
{
    const History& history = history_[axis];
    if (std::popcount(history.absent_frames) >= absent_of_32) return AxisFault::absent;
    if (!present(measurement, axis)) return AxisFault::none;
    const double limit = cluster_.range(static_cast<Eigen::Index>(axis)) * measurement.interval_s;
    if (limit > 0 && std::abs(measurement.increment[axis]) > beyond_range * limit) return AxisFault::out_of_range;
    if (is_railed(measurement, axis)) return AxisFault::rail;
    if (has_axis(noisy_, axis) && is_frozen(history)) return history.last == 0 ? AxisFault::zero : AxisFault::frozen;
    return AxisFault::none;
}

bool AxisHealth::is_frozen(const History& history) const
{
    if (history.repeats_in_motion >= repeats_while_it_should_move) return true;
    if (history.seen < habit_frames) return false;
    return history.repeats * std::log((history.repeated + 1) / (history.seen + 2)) < improbable_run;
}

bool AxisHealth::is_near_range(const Measurement& measurement, std::size_t axis) const
{
    const double limit = cluster_.range(static_cast<Eigen::Index>(axis)) * measurement.interval_s;
    return limit > 0 && std::abs(measurement.increment[axis]) >= near_range * limit;
}

bool AxisHealth::is_railed(const Measurement& measurement, std::size_t axis) const
{
    const History& history = history_[axis];
    const double limit = cluster_.range(static_cast<Eigen::Index>(axis)) * measurement.interval_s;
    return is_near_range(measurement, axis) && history.is_predicted && std::abs(history.predicted) < others_range * limit &&
           !is_borne_out(cluster_, measurement, axis, others_range * limit);
}

}  // namespace quorient::fdi
