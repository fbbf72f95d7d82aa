#pragma once

#include "quorient/geometry/layouts.hpp"
#include "quorient/messages/limits.hpp"
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

/// A valid frame. @param exact  increments of all axes [rad]  @param measure  (axis, exact increment) -> what the axis gives out
template <class Exact, class Measure>
SensorFrame measured_frame(std::uint64_t sequence, double interval_s, const Exact& exact, Measure&& measure)
{
    SensorFrame frame;
    frame.epoch = 1;
    frame.sequence = sequence;
    frame.interval_s = interval_s;
    const auto axes = static_cast<std::size_t>(exact.size());
    frame.axis_count = static_cast<std::uint8_t>(axes);
    frame.valid_mask = all_axes(axes);
    for (std::size_t axis = 0; axis < axes; ++axis) frame.increment[axis] = measure(axis, exact(static_cast<Eigen::Index>(axis)));
    return frame;
}

}  // namespace quorient::fdi
