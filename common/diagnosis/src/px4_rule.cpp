#include "quorient/diagnosis/px4_rule.hpp"

#include "quorient/geometry/triads.hpp"
#include "quorient/messages/units.hpp"

#include <Eigen/Core>
#include <algorithm>

namespace quorient::diagnosis {

namespace {

constexpr double px4_tolerated_rad_s = 7 * degree;
constexpr double faulty_rad = 15 * degree;
constexpr double smoothing = 0.05;

}  // namespace

Px4Rule::Px4Rule(const geometry::SensorCluster& cluster) : size_(cluster.axes.rows())
{
    for (std::size_t number = 0; number < cluster.instrument_name.size(); ++number) {
        Instrument instrument;
        instrument.axes = cluster.axes_of(number);
        if (instrument.axes == 0) continue;
        const auto body_from_axes = geometry::least_squares_inverse(cluster.axes, instrument.axes);
        if (!body_from_axes) continue;
        instrument.body_from_axes = *body_from_axes;
        instruments_.push_back(std::move(instrument));
    }
}

AxisMask Px4Rule::update(const SensorFrame& frame)
{
    const Eigen::Map<const Eigen::VectorXd> increments(frame.increment.data(), size_);
    Eigen::Vector3d mean = Eigen::Vector3d::Zero();
    for (const Instrument& instrument : instruments_) mean += instrument.body_from_axes * increments;
    mean /= static_cast<double>(instruments_.size());
    for (Instrument& instrument : instruments_) {
        const Eigen::Vector3d difference = (instrument.body_from_axes * increments - mean) / frame.interval_s;
        instrument.difference += smoothing * (difference - instrument.difference);
        const double excess = instrument.difference.norm() - px4_tolerated_rad_s;
        instrument.integral_rad = std::max(0.0, instrument.integral_rad + excess * frame.interval_s);
    }
    const auto worst = std::max_element(instruments_.begin(), instruments_.end(),
                                        [](const Instrument& a, const Instrument& b) { return a.integral_rad < b.integral_rad; });
    return worst->integral_rad > faulty_rad ? worst->axes : 0;
}

}  // namespace quorient::diagnosis
