#pragma once

#include "quorient/rotation/quaternion.hpp"

#include <algorithm>
#include <array>
#include <cmath>

namespace quorient::rotation {

/// Roll, pitch and yaw [rad] of q_RB: about x, y, z of the body, yaw first. For people: near a pitch of +-pi/2 roll and yaw mean little.
inline std::array<double, 3> roll_pitch_yaw(const Wxyz& q)
{
    const auto [w, x, y, z] = q;
    return {std::atan2(2 * (w * x + y * z), 1 - 2 * (x * x + y * y)), std::asin(std::clamp(2 * (w * y - z * x), -1.0, 1.0)),
            std::atan2(2 * (w * z + x * y), 1 - 2 * (y * y + z * z))};
}

}  // namespace quorient::rotation
