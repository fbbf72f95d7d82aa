#pragma once

#include "quorient/rotation/quaternion.hpp"

#include <string>
#include <tl/expected.hpp>

namespace quorient::attitude {

using namespace rotation;  // quaternions are this room's numbers

/// The attitude of a body at rest, from what its accelerometers feel: R's z axis points up, so that the specific force at rest
/// is (0, 0, +g) in R. Roll and pitch follow from gravity, the heading is given.
///
/// q_RB = yaw(heading) o pitch o roll (z-y-x order). Of accelerometer errors b the tilt takes |b| / g [rad].
///
/// @param specific_force  mean over a time at rest, body frame [m/s^2]
/// @param heading_rad     about R's z axis
/// @returns an error where the specific force is not finite or not within 20 % of 9.80665 m/s^2 (the body is not at rest).
tl::expected<Quaternion, std::string> level(const Eigen::Vector3d& specific_force, double heading_rad);

}  // namespace quorient::attitude
