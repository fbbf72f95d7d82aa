#include "single_frame/frame_detector.hpp"

#include "quorient/geometry/redundancy.hpp"

#include <algorithm>
#include <cmath>
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
    AxisMask offered = 0;
    const std::size_t given = std::min(cluster_.size(), measurement.increment.size());
    for (std::size_t axis = 0; axis < given; ++axis)
        if (std::isfinite(measurement.increment[axis])) offered |= axis_bit(axis);
    work_with(offered & measurement.valid & ~excluded_);

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
