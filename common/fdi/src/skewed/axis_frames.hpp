#pragma once

#include "field/frame_grid.hpp"
#include "skewed/axis_parity.hpp"

namespace quorient::fdi::skewed {

/// One frame as it is compared: what every axis says.
struct AxisFrame {
    std::uint64_t sequence = 0;  ///< its first measurement's
    double interval_s = 0;
    bool follows = false;        ///< no measurement is missing between this frame and the one before
    AxisSet present;             ///< valid and finite
    AxisSet near_range;          ///< within 2.5 % of the range, or beyond it
    PerAxis rate{};              ///< rad/s; meaningless where it is not present
};

/// Turns measurements into frames (FrameGrid).
class AxisFrames {
public:
    explicit AxisFrames(const geometry::SensorCluster& cluster) : cluster_(cluster), grid_(cluster.interval_s) {}

    /// @returns whether this measurement completes a frame.
    bool add(const Measurement& measurement);
    const AxisFrame& frame() const { return frame_; }

    void reset() { grid_.reset(); }

    double interval_s() const { return grid_.interval_s(); }  ///< nominal, of a frame

private:
    const geometry::SensorCluster& cluster_;
    field::FrameGrid grid_;
    AxisFrame frame_;     ///< the newest complete one
    AxisFrame building_;  ///< rate holds increments
};

}  // namespace quorient::fdi::skewed
