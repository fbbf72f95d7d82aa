#pragma once

#include "quorient/geometry/sensor_cluster.hpp"

#include <span>

namespace quorient::geometry {

/// An axis closer to a plane than this (sine of the angle) counts as lying in it, and a flatter cluster counts as a plane.
/// Faults that this tolerance hides would have to be a million times the noise.
inline constexpr double coplanar_tolerance = 1e-6;

/// Rank of the rows in use: 3 where they span space.
int rank_of(const Axes& axes, AxisMask used = ~AxisMask{0});

/// How many simultaneous axis faults one sample's parity detects *whatever their sizes*: the largest k for which every k columns
/// of V are independent. 0 where the axes in use do not span space or none is redundant. [paper 002, rank rule]
///
/// Faults f leave no parity where f = H x for some x, so the smallest undetectable set is that of the axes not perpendicular to
/// some x: all but those in one plane. Hence k = m - (most axes in one plane) - 1, found from the planes of all pairs of axes.
/// @param used  axes to work with.
unsigned detectable_with(const Axes& axes, AxisMask used = ~AxisMask{0});

/// How many it isolates whatever their sizes: the largest k for which every 2k columns of V are independent.
unsigned isolable_with(const Axes& axes, AxisMask used = ~AxisMask{0});

/// The same where a fault takes a whole instrument: an instrument counts as lying in a plane if all its axes in use do.
/// @param instrument  instrument of each axis, n entries.
unsigned detectable_instruments_with(const Axes& axes, std::span<const std::size_t> instrument, AxisMask used = ~AxisMask{0});
unsigned isolable_instruments_with(const Axes& axes, std::span<const std::size_t> instrument, AxisMask used = ~AxisMask{0});

}  // namespace quorient::geometry
