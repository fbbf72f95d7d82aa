#pragma once

#include "quorient/geometry/sensor_cluster.hpp"
#include "quorient/messages/exclusions.hpp"
#include "quorient/messages/sensor_frame.hpp"
#include "quorient/rotation/quaternion.hpp"

#include <Eigen/Core>
#include <map>
#include <vector>

namespace quorient::studies {

/// Least-squares increments of the body from some axes of a cluster.
class Body {
public:
    explicit Body(const geometry::SensorCluster& cluster) : cluster_(cluster) {}

    /// @param used  axes that span space
    Eigen::Vector3d increment(const SensorFrame& frame, AxisMask used);

private:
    const geometry::SensorCluster& cluster_;
    std::map<AxisMask, Eigen::MatrixXd> inverse_;
};

/// How far an attitude is from the one that nothing has spoiled, about any direction [rad].
struct AttitudeError {
    double largest_rad = 0;  ///< as it was known at each instant
    double at_end_rad = 0;
};

/// An attitude from its identity on, with the memory to leave axes out afterwards.
class Attitude {
public:
    /// @param used  axes of the cluster that it is made from
    Attitude(const geometry::SensorCluster& cluster, AxisMask used) : body_(cluster), used_(used) {}

    void add(const SensorFrame& frame);

    /// From these sequences to the newest frame, and all that follows from there on.
    void leave_out(const Exclusions& excluded_from);

    std::size_t size() const { return after_.size(); }

    /// @param k  count of frames added before this one
    const rotation::Quaternion& after(std::size_t k) const { return after_[k]; }

private:
    void integrate_from(std::size_t k);

    Body body_;
    AxisMask used_;
    std::vector<SensorFrame> frames_;
    std::vector<AxisMask> left_out_;
    std::vector<rotation::Quaternion> after_;
};

}  // namespace quorient::studies
