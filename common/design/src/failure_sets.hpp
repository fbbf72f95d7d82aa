#pragma once

#include "quorient/messages/limits.hpp"

#include <span>
#include <vector>

namespace quorient::design {

/// The axes that each unit takes with it when it fails: of every instrument, or (`axes_alone`) of every axis.
std::vector<AxisMask> axes_of_units(std::span<const std::size_t> instrument, bool axes_alone);

/// The axes lost by every choice of `count` units.
std::vector<AxisMask> failure_sets(std::span<const AxisMask> units, unsigned count);

}  // namespace quorient::design
