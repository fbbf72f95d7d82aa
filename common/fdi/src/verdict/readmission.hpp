#pragma once

#include "quorient/fdi/detector.hpp"
#include "quorient/geometry/sensor_cluster.hpp"

#include <array>

namespace quorient::fdi {

/// Watches excluded axes and reports when one has earned its place again: for a stated time it agreed with the working axes *while
/// the motion along it was at least that which exposed its fault*. A soft gyro at rest looks healthy and earns nothing.
///
/// Agreement is judged per frame and, because faults below one frame's noise exist, on the sum over the whole time.
/// Never readmits: axes whose exclusion was not seen here (adopted after a restart), and axes of a cluster with neither sigma nor
/// quantum, for nothing then says what agreement is. Allocates nothing.
class Readmission {
public:
    /// @param healthy_s  time under excitation that is asked for, above 0.
    Readmission(const geometry::SensorCluster& cluster, double healthy_s);

    /// These axes were excluded at this frame; its motion is what exposed them.
    void excluded(AxisMask newly, const Measurement& measurement, AxisMask working);

    /// @returns the excluded axes that may be trusted again after this frame.
    AxisMask watch(const Measurement& measurement, AxisMask isolated, AxisMask working);

private:
    struct Trial {
        bool exposed = false;
        double excitation = 0;    ///< |rate along the axis| that exposed the fault [rad/s; m/s^2]
        double healthy_s = 0;     ///< served so far
        double frames = 0;        ///< that served
        double residual_sum = 0;  ///< over them [unit of z]
    };

    void prepare(AxisMask working);
    bool can_predict(const Measurement& measurement, AxisMask working) const;
    double predicted(std::size_t axis, const Measurement& measurement) const;
    bool serve(Trial& trial, std::size_t axis, const Measurement& measurement) const;

    geometry::SensorCluster cluster_;
    double healthy_s_;
    AxisMask working_ = 0;               ///< what the weights below were made for
    bool spans_ = false;                 ///< the working axes span space
    geometry::AxisMatrix weight_;        ///< row i: prediction of axis i from the working axes
    geometry::AxisVector noise_;         ///< standard deviation of one residual [unit of z]
    geometry::AxisVector quantisation_;  ///< largest |residual| that carried quantisation alone makes [unit of z]
    std::array<Trial, max_axes> trial_{};
};

}  // namespace quorient::fdi
