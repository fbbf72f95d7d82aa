#include "quorient/calibration/silence.hpp"

#include "quorient/fdi/fault_monitor.hpp"
#include "quorient/geometry/sensor_cluster.hpp"
#include "quorient/messages/exclusions.hpp"

#include <algorithm>
#include <cmath>

namespace quorient::calibration {
namespace {

constexpr double raised_by = 1.2;
constexpr double highest_level = 100;

fdi::DetectorSettings settings_of(std::string_view method, const CalibratedCluster& cluster)
{
    fdi::DetectorSettings settings{.method = std::string(method)};
    settings.calibrated = true;
    settings.instruments = true;
    if (cluster.motion_level > 0) settings.motion_noise = cluster.motion_level;
    settings.gated_noise = cluster.gated;
    return settings;
}

void take(const Sample& sample, const CalibratedCluster& cluster, SensorFrame& frame)
{
    const std::size_t axes = cluster.description.axis_count;
    frame.sequence += sample.follows ? 1 : 2;  // how much is missing makes no difference
    frame.interval_s = sample.interval_s;
    frame.valid_mask = sample.complete ? all_axes(axes) : 0;
    for (std::size_t axis = 0; axis < axes; ++axis) frame.increment[axis] = cluster.corrected(sample, axis);
}

std::optional<Replayed> replay(std::string_view method, Samples samples, const CalibratedCluster& calibrated, const geometry::SensorCluster& cluster)
{
    auto monitor = fdi::FaultMonitor::make(settings_of(method, calibrated), {}, cluster);
    if (!monitor) return std::nullopt;
    Replayed replayed{.method = method};
    SensorFrame frame;
    frame.epoch = 1;
    frame.axis_count = calibrated.description.axis_count;
    for (const Sample& sample : samples) {
        take(sample, calibrated, frame);
        const FaultVerdict& verdict = monitor->assess(frame);
        if (verdict.isolated_mask != 0 && replayed.isolated == 0) replayed.first_s = sample.time_s;
        replayed.isolated |= verdict.isolated_mask;
    }
    return replayed;
}

/// The instruments that own these axes.
AxisMask instruments_with(const std::vector<OutsideClass>& outside, const geometry::SensorCluster& cluster)
{
    AxisMask mask = 0;
    for (const OutsideClass& axis : outside) mask |= cluster.axes_of(cluster.instrument[axis.axis]);
    return mask;
}

void raise(CalibratedCluster& cluster)
{
    cluster.motion_level = std::min(highest_level, std::max(1.0, cluster.motion_level) * raised_by);
    if (!cluster.gated) return;
    using fdi::MotionNoise;
    for (double MotionNoise::*term :
         {&MotionNoise::jitter_along_s, &MotionNoise::jitter_across_s, &MotionNoise::axes_error, &MotionNoise::rate_error})
        (*cluster.gated).*term *= raised_by;
}

}  // namespace

std::optional<Silence> make_silent(Samples samples, Calibration& calibration)
{
    const auto cluster = geometry::make_cluster(calibration.cluster.description);
    if (!cluster) return std::nullopt;
    const AxisMask sound = cluster->all() & ~instruments_with(calibration.outside, *cluster);
    auto accumulating = replay("accumulating", samples, calibration.cluster, *cluster);
    while (accumulating && (accumulating->isolated & sound) != 0 && calibration.outside.empty() &&
           calibration.cluster.motion_level < highest_level) {
        raise(calibration.cluster);
        accumulating = replay("accumulating", samples, calibration.cluster, *cluster);
    }
    const auto field = replay("field", samples, calibration.cluster, *cluster);
    if (!accumulating || !field) return std::nullopt;
    return Silence{.replayed = {*field, *accumulating},
                   .at_limit = calibration.cluster.motion_level >= highest_level && (accumulating->isolated & sound) != 0};
}

}  // namespace quorient::calibration
