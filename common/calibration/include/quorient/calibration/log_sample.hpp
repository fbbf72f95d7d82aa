#pragma once

#include "quorient/calibration/sample.hpp"
#include "quorient/recording/reader.hpp"

namespace quorient::calibration {

/// A frame of a log as calibration sees it.
inline Sample sample_of(const recording::RecordedFrame& frame)
{
    Sample sample;
    sample.time_s = static_cast<double>(frame.time_ns) * 1e-9;
    sample.interval_s = frame.interval_s;
    sample.rate = Eigen::Map<const Eigen::VectorXd>(frame.increment.data(), static_cast<Eigen::Index>(frame.axis_count)) / frame.interval_s;
    sample.complete = frame.valid_mask == all_axes(frame.axis_count);
    sample.follows = frame.lost_before == 0;
    return sample;
}

}  // namespace quorient::calibration
