#pragma once

#include "quorient/fdi/sensor_class.hpp"
#include "quorient/geometry/sensor_cluster.hpp"
#include "quorient/messages/limits.hpp"

#include <Eigen/Core>
#include <optional>
#include <string>
#include <vector>

namespace quorient::calibration {

/// What one axis measures beyond its class of what the sound instruments measure.
struct OutsideClass {
    enum class Kind : std::uint8_t { gain, sign, bias };

    std::size_t axis = 0;
    Kind kind = Kind::gain;
    double gain = 1;  ///< length of the direction that it measures along; negative where it is reversed
    double gain_sigma = 0;
    double bias_rad_s = 0;
    double bias_sigma_rad_s = 0;
};

/// Which instruments of an array agree with each other, and which axes do not.
struct Consensus {
    std::vector<OutsideClass> outside;              ///< in the order of the axes; empty where all are sound
    AxisMask outside_mask = 0;
    std::string ambiguous;                          ///< instruments disagree beyond their class and none can be named: why; or empty
    std::vector<Eigen::Matrix3d> to_first;          ///< per instrument: rotation from its own frame to the first one's; filled where axes are outside
};

/// Compares the instruments of an array pair by pair. For an axis a of an instrument and the rates w_j of another one, robust least squares
/// (Huber's weights) give  y_a = g'w_j + b. Two instruments agree if every |g| is within 10 % of 1 and every b within the class. The largest
/// set around one instrument that agrees with all of its members is sound if it is the majority; the others' axes are judged against it.
///
/// Not seen: what is common to the majority, and gains where the motion is weak (below 5 times the disagreement about some axis).
///
/// @param rates  of all axes, raw, averaged over vibration; away from saturation
Consensus consensus_of(const std::vector<geometry::AxisVector>& rates, const geometry::SensorCluster& cluster,
                       const fdi::ClassFigures& figures = fdi::figures_of(fdi::SensorClass::consumer));

}  // namespace quorient::calibration
