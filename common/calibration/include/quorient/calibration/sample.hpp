#pragma once

#include "quorient/geometry/sensor_cluster.hpp"

#include <cstddef>
#include <span>

namespace quorient::calibration {

/// One frame of a recording: what each axis measured, as a rate.
struct Sample {
    double time_s = 0;  ///< end of the interval, from the log's beginning
    double interval_s = 0;
    geometry::AxisVector rate;  ///< [rad/s]
    bool complete = true;       ///< every axis is valid
    bool follows = true;        ///< nothing is missing between the sample before and this one
};

using Samples = std::span<const Sample>;

/// Samples [begin, end).
struct Segment {
    std::size_t begin = 0;
    std::size_t end = 0;

    std::size_t size() const { return end - begin; }
};

}  // namespace quorient::calibration
