#include "single_frame/frame_detector.hpp"

#include "quorient/geometry/redundancy.hpp"

#include <utility>

namespace quorient::fdi {

FrameDetector::FrameDetector(geometry::SensorCluster cluster)
    : cluster_(std::move(cluster)),
      detectable_remaining_(geometry::detectable_with(cluster_.axes)),
      z_(geometry::AxisVector::Zero(cluster_.axes.rows()))
{
}

void FrameDetector::assess(const Measurement& measurement, Assessment& assessment)
{
    assessment = {};
    work_with(measurement.usable_of(cluster_.all() & ~excluded_));

    for (std::size_t axis = 0; axis < cluster_.size(); ++axis)
        z_(static_cast<Eigen::Index>(axis)) = has_axis(working_, axis) ? measurement.increment[axis] : 0;
    judge(z_, assessment);
}

void FrameDetector::exclude(AxisMask excluded)
{
    excluded_ = excluded;
    detectable_remaining_ = geometry::detectable_with(cluster_.axes, cluster_.all() & ~excluded_);
    work_with(cluster_.all() & ~excluded_);
}

void FrameDetector::work_with(AxisMask working)
{
    if (working == working_) return;  // no method is formed for no axes: it then has no tables, and judges nothing
    working_ = working;
    form(working_);
}

}  // namespace quorient::fdi
