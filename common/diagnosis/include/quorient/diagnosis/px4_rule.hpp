#pragma once

#include "quorient/geometry/sensor_cluster.hpp"
#include "quorient/messages/sensor_frame.hpp"

#include <Eigen/Core>
#include <vector>

namespace quorient::diagnosis {

/// For comparison: how PX4's estimator selector finds a faulty gyro among three or more, written from its description.
/// Each instrument's difference to the mean of all is low-passed (19/20 of the old value per sample); what its norm exceeds
/// 7 deg/s by is integrated, never below 0; once any integral exceeds 15 deg, the instrument with the largest one is faulty.
class Px4Rule {
public:
    explicit Px4Rule(const geometry::SensorCluster& cluster);

    /// @returns the axes of the instrument that the rule calls faulty in this frame, 0 = none.
    AxisMask update(const SensorFrame& frame);

private:
    struct Instrument {
        AxisMask axes = 0;
        Eigen::Matrix3Xd body_from_axes;  ///< 3 x all axes, 0 where not its own
        Eigen::Vector3d difference = Eigen::Vector3d::Zero();
        double integral_rad = 0;
    };

    std::vector<Instrument> instruments_;
    Eigen::Index size_;
};

}  // namespace quorient::diagnosis
