#pragma once

#include <numbers>

namespace quorient {

/// In radians. Angles are radians inside the project: `5 * degree` is written where people think in degrees, `angle / degree` where they read them.
inline constexpr double degree = std::numbers::pi / 180;

}  // namespace quorient
