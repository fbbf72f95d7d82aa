#pragma once

#include "quorient/geometry/sensor_cluster.hpp"

namespace quorient::fdi {

/// How wrong the axes of a real array are beyond their noise at rest. Each term is one standard deviation.
struct MotionNoise {
    double jitter_along_s = 0;    ///< times |d omega/dt|: each instrument's sampling instants wander; along d omega/dt …
    double jitter_across_s = 0;   ///< … and across it; both independent between frames and between instruments
    double roughness_s = 0;       ///< times the lately largest |d omega/dt|: outliers, which a few frames of a window dominate
    double axes_error = 0;        ///< times the rotation: misalignment and scale that calibration left; what turns back is taken back
    double rate_error = 0;        ///< times the angle turned through, whichever way: errors of another law (asymmetry, rate squared)
    double bias_floor_rad_s = 0;  ///< constant error of each axis that calibration left
};

/// What to expect of an array that was calibrated: fractions of its interval and of its own noise, as the two MIMU4444 recordings
/// show them (common/fdi/README.md has the figures). Negligible beside the noise where the motion is gentle.
/// @param level  multiplies all that moving brings in: 1 for arrays like those, else what a recording of the array shows.
MotionNoise usual_motion_noise(const geometry::SensorCluster& cluster, double level = 1);

}  // namespace quorient::fdi
