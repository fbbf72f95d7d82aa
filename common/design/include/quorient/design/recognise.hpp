#pragma once

#include "quorient/geometry/sensor_cluster.hpp"

#include <string>

namespace quorient::design {

/// The named layout that has the same angles between its axes and the same volumes of its triads (as lines, in any order, to 1e-6);
/// empty where there is none. For up to 8 axes.
std::string same_as(const geometry::Axes& axes);

/// An array turned so that it is easy to read.
struct Upright {
    geometry::Axes axes;
    unsigned symmetry = 1;  ///< order of the rotation about z that maps the lines on themselves
};

/// Turns the whole array: its axis of highest rotational symmetry (of at least 2, up to 12 axes) becomes z, else axis 0 does.
/// @param single  every axis is an instrument of its own: signs are then chosen so that z is not negative, and axes are sorted
///                from z down and by azimuth.
Upright upright(const geometry::Axes& axes, bool single);

}  // namespace quorient::design
