#pragma once

#include "field/frame_grid.hpp"
#include "field/parameters.hpp"
#include "quorient/fdi/detector.hpp"

namespace quorient::fdi::field {

/// One frame as it is compared: what every instrument says of the body's rate, in one common frame.
struct Frame {
    std::uint64_t sequence = 0;    ///< its first measurement's
    double interval_s = 0;
    bool follows = false;          ///< no measurement is missing between this frame and the one before
    InstrumentSet present;         ///< all axes valid and finite
    AxisMask near_range = 0;       ///< axes within 2.5 % of their range, or beyond it
    InstrumentArray::BodyVectors rate;  ///< rad/s, one column per instrument; meaningless where it is not present
};

/// Turns measurements into frames (FrameGrid).
///
/// The axes of the common frame are those of the first instrument where it has three: a faulty axis of parallel instruments then shows in one
/// component alone.
class Framing {
public:
    Framing(const geometry::SensorCluster& cluster, const InstrumentArray& array);

    /// @returns whether this measurement completes a frame.
    bool add(const Measurement& measurement);
    const Frame& frame() const { return frame_; }

    void reset() { grid_.reset(); }

    double interval_s() const { return grid_.interval_s(); }  ///< nominal, of a frame
    const geometry::Axes& axes() const { return axes_; }  ///< in the common frame

private:
    void begin(const Measurement& measurement);

    const InstrumentArray& array_;
    Eigen::Matrix3d common_from_body_;
    geometry::Axes axes_;
    FrameGrid grid_;
    Frame frame_;                                 ///< the newest complete one
    Frame building_;                              ///< rate holds increments
};

}  // namespace quorient::fdi::field
