#include "quorient/bus/local_bus.hpp"
#include "quorient/bus/ros2.hpp"
#include "quorient/geometry/layouts.hpp"
#include "quorient/runtime/event_loop.hpp"
#include "sources.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <cmath>
#include <functional>
#include <random>

namespace quorient::sensor {
namespace {

using testing::HasSubstr;

constexpr std::int64_t ms = 1'000'000;
constexpr double degree = 3.14159265358979323846 / 180;
constexpr std::array<double, 6> bias_rad_s{0.35 * degree, -0.2 * degree, 0.4 * degree, -0.65 * degree, 0.25 * degree, 0.5 * degree};
constexpr std::array<double, 6> gain{1.02, 0.99, 1.01, 0.98, 1.0, 1.03};

/// A sensor of two IMUs on the local bus under virtual time: 200 Hz, stamps without an error.
class Ros2Biases : public testing::Test {
protected:
    using Rate = std::function<double(double t, std::size_t axis)>;

    Ros2Biases()
    {
        settings.cluster = geometry::layout("triads-2").value();
        settings.cluster->interval_s = 0.005;
        settings.source.ros2.emplace();
        for (const char* name : {"front", "rear"}) {
            settings.source.ros2->imus.push_back({.topic = std::string("rt/") + name + "/data", .name = name});
            publishers.push_back(robot->advertise(bus::ros2::imu(("rt/" + std::string(name) + "/data").c_str(), bus::ros2::offered)));
        }
    }

    /// The frames of so many seconds. @param rate  what an axis measures beside its noise
    std::vector<SensorFrame> run(double duration_s, const Rate& rate)
    {
        auto made = make_source(settings, 1);
        if (!made) throw std::runtime_error(made.error());
        source = std::move(*made);
        source->attach(*bus, loop);
        std::vector<SensorFrame> frames;
        SensorFrame frame;
        TruthState truth;
        for (std::int64_t now = 5 * ms; now < std::llround(duration_s * 1e9); now += 5 * ms) {
            clock.set(now);
            for (std::size_t imu = 0; imu < 2; ++imu) {
                bus::ros2::Imu message{.stamp_ns = now};
                for (std::size_t k = 0; k < 3; ++k)
                    message.rate_rad_s[k] = rate(static_cast<double>(now) * 1e-9, 3 * imu + k) + 0.05 * degree * normal(random);
                publishers[imu].publish(message);
            }
            while (loop.dispatch()) continue;
            if (source->advance_to(frames.size(), frame, truth) == Advance::frame) frames.push_back(frame);
            while (auto notice = source->notice()) notices += notice->text + "\n";
        }
        return frames;
    }

    static double mean_rate(const std::vector<SensorFrame>& frames, std::size_t axis)
    {
        double sum = 0;
        for (const SensorFrame& frame : frames) sum += frame.increment[axis] / frame.interval_s;
        return sum / static_cast<double>(frames.size());
    }

    system::SensorSettings settings;
    bus::LocalHub hub;
    std::unique_ptr<bus::Bus> bus = hub.open(), robot = hub.open();
    std::vector<bus::Publisher<bus::ros2::Imu>> publishers;
    runtime::VirtualClock clock;
    const std::atomic<bool> never_stop{false};
    runtime::EventLoop loop{*bus, clock, never_stop};
    std::unique_ptr<FrameSource> source;
    std::string notices;
    std::mt19937_64 random{9};
    std::normal_distribution<double> normal;
};

TEST_F(Ros2Biases, are_learned_at_rest_before_the_first_frame_and_stand_in_its_description)
{
    const auto frames = run(6, [](double, std::size_t axis) { return bias_rad_s[axis]; });

    ASSERT_GT(frames.size(), 600U);
    const ClusterDescription& description = source->description();
    EXPECT_EQ(description.revision, 2U);
    for (std::size_t axis = 0; axis < 6; ++axis) {
        EXPECT_NEAR(description.bias[axis], bias_rad_s[axis], 0.02 * degree) << axis;
        EXPECT_NEAR(mean_rate(frames, axis), 0, 0.02 * degree) << axis;
        EXPECT_GT(description.sigma[axis], 0) << axis;
    }
    for (const SensorFrame& frame : frames) ASSERT_EQ(frame.description_revision, 2U);
    EXPECT_EQ(frames.front().sequence, 0U);
    EXPECT_THAT(notices, HasSubstr("front: bias at rest +0.3"));
    EXPECT_THAT(notices, HasSubstr("rear: bias at rest -0.6"));
}

TEST_F(Ros2Biases, are_not_learned_in_motion_and_the_frames_do_not_wait)
{
    const auto turning = [](double t, std::size_t axis) { return bias_rad_s[axis] + 0.4 * std::sin(3 * t + static_cast<double>(axis % 3)); };
    const auto frames = run(3, turning);

    EXPECT_GT(frames.size(), 400U);
    EXPECT_EQ(source->description().revision, 1U);
    EXPECT_EQ(source->description().bias[0], 0);
    EXPECT_THAT(notices, HasSubstr("the IMUs move at the start"));
}

TEST_F(Ros2Biases, and_gains_are_those_of_the_calibration_where_there_is_one)
{
    calibration::CalibratedCluster calibrated;
    calibrated.gain.fill(1);
    for (std::size_t axis = 0; axis < 6; ++axis) {
        calibrated.description.bias[axis] = bias_rad_s[axis];
        calibrated.gain[axis] = gain[axis];
    }
    settings.source.calibration = calibrated;
    settings.source.ros2->rest_s = 0;
    const double rate = 0.5;
    const auto frames = run(4, [&](double, std::size_t axis) { return gain[axis] * rate + bias_rad_s[axis]; });

    ASSERT_GT(frames.size(), 600U);
    for (std::size_t axis = 0; axis < 6; ++axis) {
        EXPECT_NEAR(mean_rate(frames, axis), rate, 0.01 * degree) << axis;
        EXPECT_EQ(source->description().bias[axis], bias_rad_s[axis]) << axis;
    }
    EXPECT_EQ(source->description().revision, 1U);
}

}  // namespace
}  // namespace quorient::sensor
