// Nothing is allocated per frame, whatever the method and whatever happens. (Linked with --wrap=malloc.)

#include "allocation_count.hpp"
#include "observer_scene.hpp"
#include "quorient/fdi/fault_monitor.hpp"
#include "quorient/fdi/methods.hpp"
#include "quorient/geometry/layouts.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <string>

namespace quorient::fdi {
namespace {

SensorFrame frame_of(const geometry::SensorCluster& cluster, std::uint64_t sequence)
{
    SensorFrame frame;
    frame.epoch = sequence < 900 ? 1 : 2;
    frame.sequence = sequence;
    frame.interval_s = cluster.interval_s;
    frame.axis_count = static_cast<std::uint8_t>(cluster.size());
    frame.valid_mask = cluster.all();
    const double phase = 0.01 * static_cast<double>(sequence);
    const geometry::AxisVector z = cluster.axes * Eigen::Vector3d(std::sin(phase), std::cos(phase), 0.3) * cluster.interval_s;
    for (std::size_t axis = 0; axis < cluster.size(); ++axis) frame.increment[axis] = z(static_cast<Eigen::Index>(axis));
    if (sequence > 500 && sequence < 700) frame.increment[1] += 0.01;
    if (sequence % 97 == 0) frame.increment[2] = std::nan("");
    return frame;
}

TEST(FaultMonitor, allocates_nothing_per_frame)
{
    for (const Method& method : methods()) {
        SCOPED_TRACE(std::string(method.word));
        const bool four = method.word == "vector" || method.word == "extrapolation";
        const bool array = method.input == MethodInput::instruments;
        auto cluster = geometry::layout(four ? "cone-4" : array ? "triads-3" : "cone-6").value();
        cluster.interval_s = 0.005;
        cluster.sigma.setConstant(1e-6);
        cluster.quantum.setConstant(1e-6);
        auto monitor = FaultMonitor::make({.method = std::string(method.word),
                                           .tolerance = 1e-5,
                                           .bound = 1e-5,
                                           .threshold = 1e-4,
                                           .gated_noise = MotionNoise{.jitter_along_s = 1e-6}},
                                          {.readmit_after_s = 0.5}, cluster);
        ASSERT_TRUE(monitor) << monitor.error();
        AxisMask isolated = 0;
        const std::size_t before = quorient::test::allocation_count();
        for (std::uint64_t sequence = 0; sequence < 1000; ++sequence)
            isolated |= monitor->assess(frame_of(cluster, sequence)).isolated_mask;
        EXPECT_EQ(quorient::test::allocation_count(), before);
        const AxisMask expected = method.word == "field" ? 0b111U : 0b10U;  // whole instruments
        EXPECT_EQ(isolated, expected) << "the fault's own path was not taken";
    }
}

TEST(FaultMonitor, allocates_nothing_per_frame_of_a_vessel)
{
    for (const auto scheme : {ObserverScheme::directional, ObserverScheme::blind}) {
        SCOPED_TRACE(std::string(to_string(scheme)));
        auto settings = test::paper_settings(scheme);
        settings.threshold.reset();
        settings.sigma = {2e-4};
        settings.model_error = 0.05;
        auto monitor = FaultMonitor::make(ObserverDetector::make(settings, 0.01).value(), {}, 2).value();
        SensorFrame frame;
        frame.interval_s = 0.01;
        frame.valid_mask = 0b11;
        AxisMask isolated = 0;
        const std::size_t before = quorient::test::allocation_count();
        for (frame.sequence = 0; frame.sequence < 2000; ++frame.sequence) {
            frame.increment[0] = 0;
            frame.increment[1] = frame.sequence < 500 ? 0 : 0.1 * frame.interval_s;
            isolated |= monitor.assess(frame).isolated_mask;
        }
        EXPECT_EQ(quorient::test::allocation_count(), before);
        EXPECT_EQ(isolated & 0b10U, 0b10U) << "the fault's own path was not taken";
    }
}

}  // namespace
}  // namespace quorient::fdi
