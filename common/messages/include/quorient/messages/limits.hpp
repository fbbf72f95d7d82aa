#pragma once

#include <cstddef>
#include <cstdint>
#include <limits>

namespace quorient {

/// Most axes of one cluster: eight triads.
inline constexpr std::size_t max_axes = 24;

/// Most candidate sets that one verdict names; more are cut and flagged.
inline constexpr std::size_t max_candidates = 8;

/// Most lanes that one voter watches.
inline constexpr std::size_t max_lanes = 8;

/// Bit i stands for axis i (0-based; the papers' G2 is axis 1).
using AxisMask = std::uint32_t;

/// Bit i stands for the lane at place i of the system's list of lanes.
using LaneMask = std::uint32_t;

/// The mask of the first `count` axes.
constexpr AxisMask all_axes(std::size_t count)
{
    return count >= 32 ? ~AxisMask{0} : (AxisMask{1} << count) - 1;
}

constexpr AxisMask axis_bit(std::size_t axis)
{
    return AxisMask{1} << axis;
}

constexpr bool has_axis(AxisMask mask, std::size_t axis)
{
    return (mask >> axis & 1U) != 0;
}

/// excluded_from of an axis that was never excluded.
inline constexpr std::uint64_t never = std::numeric_limits<std::uint64_t>::max();

}  // namespace quorient
