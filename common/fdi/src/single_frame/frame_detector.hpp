#pragma once

#include "quorient/fdi/detector.hpp"
#include "quorient/geometry/sensor_cluster.hpp"

namespace quorient::fdi {

/// A method that judges every frame on its own. It re-forms itself whenever the set of axes that a frame offers changes: excluded
/// axes, axes outside `valid` and axes whose increment is not finite are left out, never blamed, and their values never read.
///
/// With the last redundancy gone (three axes, or fewer) nothing can contradict anything: every frame is then `healthy` with
/// statistic 0, and detectable_remaining() is 0, which is what has to be watched.
class FrameDetector : public Detector {
public:
    void assess(const Measurement& measurement, Assessment& assessment) final;
    void exclude(AxisMask excluded) final;

    /// By the rank rule of paper 002, see geometry::detectable_with.
    unsigned detectable_remaining() const final { return detectable_remaining_; }

protected:
    explicit FrameDetector(geometry::SensorCluster cluster);

    /// Prepares the method for these axes; allocates nothing.
    virtual void form(AxisMask working) = 0;

    /// Judges one frame. `z` has one entry per axis of the cluster, 0 for those outside working().
    virtual void judge(const geometry::AxisVector& z, Assessment& assessment) = 0;

    const geometry::SensorCluster& cluster() const { return cluster_; }
    AxisMask working() const { return working_; }

private:
    void work_with(AxisMask working);

    geometry::SensorCluster cluster_;
    AxisMask excluded_ = 0;
    AxisMask working_ = 0;
    unsigned detectable_remaining_ = 0;
    geometry::AxisVector z_;
};

}  // namespace quorient::fdi
