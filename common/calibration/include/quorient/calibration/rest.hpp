#pragma once

#include "quorient/calibration/sample.hpp"

#include <vector>

namespace quorient::calibration {

struct RestSettings {
    double window_s = 1.0;          ///< length of the windows that are judged
    double shortest_s = 4.0;        ///< shortest segment, before its ends are cut by half a window each
    double deviation_rad_s = 0.02;  ///< above it nothing rests, however quiet it is relative to the rest of the log
    double quiet_factor = 3.0;      ///< a window rests if its variance is below this multiple of the quietest tenth's
    double mean_rad_s = 0.02;  ///< farthest that a window's mean may lie from the median of the quiet windows' (a slow turn is no rest)
};

/// The segments in which the sensors rested, in order, without gaps or missing axes inside.
std::vector<Segment> resting_segments(Samples samples, const RestSettings& settings = {});

/// Bias and noise of each axis from the resting segments.
struct RestFigures {
    geometry::AxisVector bias_rad_s;         ///< mean over all resting samples
    geometry::AxisVector bias_spread_rad_s;  ///< standard deviation of the segments' means: how far a bias wanders
    geometry::AxisVector deviation_rad_s;    ///< standard deviation of one sample about its segment's mean
};

/// @param segments  at least one, not empty.
RestFigures rest_figures(Samples samples, const std::vector<Segment>& segments);

/// One averaging time of an Allan deviation.
struct AllanPoint {
    double tau_s = 0;
    geometry::AxisVector deviation_rad_s;
    std::size_t terms = 0;  ///< differences that the estimate is made of
};

/// Overlapping Allan deviation of every axis over the resting segments, at averaging times of 1, 2, 4 … samples up to a third of the
/// longest segment; the segments' terms are pooled. [IEEE Std 952-1997, annex C]
std::vector<AllanPoint> allan_deviation(Samples samples, const std::vector<Segment>& segments);

/// The usual figures of an Allan deviation.
struct AllanFigures {
    geometry::AxisVector random_walk_rad_sqrt_s;  ///< deviation x sqrt(tau), median over the first four points
    geometry::AxisVector bias_instability_rad_s;  ///< smallest deviation / 0.664
};

/// @param points  at least one.
AllanFigures allan_figures(const std::vector<AllanPoint>& points);

}  // namespace quorient::calibration
