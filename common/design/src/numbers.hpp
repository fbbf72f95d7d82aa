#pragma once

#include <limits>
#include <numbers>

namespace quorient::design {

using std::numbers::pi;
inline constexpr double infinity = std::numeric_limits<double>::infinity();

}  // namespace quorient::design
