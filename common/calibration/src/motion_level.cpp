#include "quorient/calibration/motion_level.hpp"

#include "arrays/accumulating_detector.hpp"
#include "quorient/geometry/sensor_cluster.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

namespace quorient::calibration {

namespace {


constexpr double largest_wanted = 0.85;
constexpr double close_enough = 0.01;
constexpr int rounds = 8;
constexpr double highest = 100;

/// Samples outside the resting segments.
std::vector<bool> moving_samples(Samples samples, const Calibration& calibration)
{
    std::vector<bool> moving(samples.size(), true);
    for (const auto& segment : calibration.rest)
        std::fill(moving.begin() + static_cast<std::ptrdiff_t>(segment.begin), moving.begin() + static_cast<std::ptrdiff_t>(segment.end),
                  false);
    return moving;
}

/// The nearest that the detector comes to its threshold (1) while the array moves.
double largest_statistic(Samples samples, const std::vector<bool>& moving, const Calibration& calibration, fdi::AccumulatingDetector& detector)
{
    const auto& cluster = calibration.cluster;
    const std::size_t axes = cluster.description.axis_count;
    std::array<double, max_axes> increment{};
    fdi::Assessment assessment;
    double largest = 0;
    for (std::size_t i = 0; i < samples.size(); ++i) {
        const Sample sample = samples[i];
        for (std::size_t axis = 0; axis < axes; ++axis) increment[axis] = cluster.corrected(sample, axis);
        detector.assess({.identity = {.epoch = 1, .sequence = i},
                         .interval_s = sample.interval_s,
                         .increment = std::span(increment).first(axes),
                         .valid = sample.complete ? all_axes(axes) : 0},
                        assessment);
        if (moving[i]) largest = std::max(largest, assessment.statistic);
    }
    return largest;
}

}  // namespace

std::optional<MotionLevel> motion_level(Samples samples, const Calibration& calibration)
{
    const auto moving = moving_samples(samples, calibration);
    const auto cluster = geometry::make_cluster(calibration.cluster.description);
    if (!cluster || std::find(moving.begin(), moving.end(), true) == moving.end()) return std::nullopt;
    AxisMask aside = 0;
    for (const OutsideClass& axis : calibration.outside) aside |= cluster->axes_of(cluster->instrument[axis.axis]);
    MotionLevel found;
    for (int round = 0; round < rounds; ++round) {
        fdi::DetectorSettings settings{.method = "accumulating"};
        settings.instruments = true;
        settings.motion_noise = found.level;
        const auto detector = fdi::AccumulatingDetector::make(settings, *cluster);
        if (!detector) return std::nullopt;
        (*detector)->exclude(aside);
        const double largest = largest_statistic(samples, moving, calibration, **detector);
        const bool small_enough = largest <= largest_wanted * (1 + close_enough);
        if (small_enough && (found.level == 1 || largest >= largest_wanted * (1 - close_enough))) break;
        // The statistic falls no faster than the level rises.
        const double next = std::clamp(found.level * largest / largest_wanted, 1.0, highest);
        if (next == found.level) {
            found.at_limit = !small_enough;
            break;
        }
        found.level = next;
    }
    return found;
}

}  // namespace quorient::calibration
