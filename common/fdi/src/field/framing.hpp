#pragma once

#include "field/parameters.hpp"
#include "quorient/fdi/detector.hpp"

namespace quorient::fdi::field {

/// One frame as it is compared: what every instrument says of the body's rate, in one common frame.
struct Frame {
    std::uint64_t sequence = 0;    ///< of its first measurement
    double interval_s = 0;
    bool follows = false;          ///< no measurement is missing between this frame and the one before
    InstrumentSet present;         ///< all axes valid and finite
    AxisMask near_range = 0;       ///< axes within 2.5 % of their range, or beyond it
    InstrumentArray::BodyVectors rate;  ///< rad/s, one column per instrument; meaningless where it is not present
};

/// Turns measurements into frames. Faster measurements than 125 Hz are summed to frames of up to 10 ms: the constants of the comparison are
/// those of arrays of 25 to 125 Hz, and what is shorter than a frame cannot harm the attitude.
///
/// The axes of the common frame are those of the first instrument where it has three: a faulty axis of parallel instruments then shows in one
/// component alone.
class Framing {
public:
    Framing(const geometry::SensorCluster& cluster, const InstrumentArray& array);

    /// @returns whether this measurement completes a frame.
    bool add(const Measurement& measurement);
    const Frame& frame() const { return frame_; }

    void reset();

    double interval_s() const { return interval_s_; }  ///< nominal, of a frame
    const geometry::Axes& axes() const { return axes_; }  ///< in the common frame

private:
    void begin(const Measurement& measurement, bool follows);

    const InstrumentArray& array_;
    Eigen::Matrix3d common_from_body_;
    geometry::Axes axes_;
    double measurement_interval_s_;
    std::size_t measurements_per_frame_;
    double interval_s_;
    Frame frame_;                                 ///< the newest complete one
    Frame building_;                              ///< rate holds increments
    std::size_t collected_ = 0;
    bool gap_ = true;  ///< since the last complete frame
    std::uint64_t next_sequence_ = 0;
};

}  // namespace quorient::fdi::field
