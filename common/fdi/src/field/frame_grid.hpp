#pragma once

#include "quorient/fdi/detector.hpp"
#include "quorient/messages/stream_place.hpp"

#include <algorithm>

namespace quorient::fdi::field {

/// Which measurements make one frame. Faster ones than 125 Hz are summed to frames of up to 10 ms: the constants of the comparison are those
/// of arrays of 25 to 125 Hz, and what is shorter than a frame cannot harm the attitude.
class FrameGrid {
public:
    explicit FrameGrid(double measurement_interval_s)
        : measurement_interval_s_(measurement_interval_s),
          measurements_per_frame_(std::max<std::size_t>(1, static_cast<std::size_t>(longest_frame_s / measurement_interval_s)))
    {
    }

    double interval_s() const { return measurement_interval_s_ * static_cast<double>(measurements_per_frame_); }  ///< nominal, of a frame

    void reset()
    {
        collected_ = 0;
        gap_ = true;
    }

    /// @returns whether a frame begins with this measurement; what was collected before it is void.
    bool begins(const Measurement& measurement)
    {
        const bool follows = place_.follows(measurement.identity) && measurement.interval_s < gap_intervals * measurement_interval_s_;
        place_ = StreamPlace::behind(measurement.identity);
        if (!follows) gap_ = true;
        if (!follows) collected_ = 0;
        return collected_ == 0;
    }

    /// The measurement has been added. @returns whether it completes the frame; `follows` then holds for it.
    bool completes()
    {
        if (++collected_ < measurements_per_frame_) return false;
        follows_ = !gap_;
        gap_ = false;
        collected_ = 0;
        return true;
    }

    /// No measurement is missing between the newest complete frame and the one before.
    bool follows() const { return follows_; }

private:
    static constexpr double longest_frame_s = 0.0105;

    /// An interval this many times the nominal one hides a lost measurement.
    static constexpr double gap_intervals = 1.7;

    double measurement_interval_s_;
    std::size_t measurements_per_frame_;
    std::size_t collected_ = 0;
    bool gap_ = true;  ///< since the last complete frame
    bool follows_ = false;
    StreamPlace place_;
};

}  // namespace quorient::fdi::field
