#pragma once

#include "quorient/geometry/layouts.hpp"
#include "quorient/messages/sensor_frame.hpp"

#include <Eigen/Core>

namespace quorient::fdi {

/// An angle encoder's step [rad].
inline constexpr double quantum = 0.4848e-6;

/// Four axes on a cone with quantised angles.
inline geometry::SensorCluster cone_4(double interval_s)
{
    auto cluster = geometry::layout("cone-4").value();
    cluster.quantum.setConstant(quantum);
    cluster.interval_s = interval_s;
    return cluster;
}

/// A valid frame of four axes. @param measure  (axis, exact increment) -> what the axis gives out  @param exact  increments [rad]
template <class Measure>
SensorFrame four_axis_frame(std::uint64_t sequence, double interval_s, const Eigen::Vector4d& exact, Measure&& measure)
{
    SensorFrame frame;
    frame.epoch = 1;
    frame.sequence = sequence;
    frame.interval_s = interval_s;
    frame.axis_count = 4;
    frame.valid_mask = 0b1111;
    for (std::size_t axis = 0; axis < 4; ++axis) frame.increment[axis] = measure(axis, exact(static_cast<Eigen::Index>(axis)));
    return frame;
}

}  // namespace quorient::fdi
