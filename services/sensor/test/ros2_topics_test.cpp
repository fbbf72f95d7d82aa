#include "quorient/bus/local_bus.hpp"
#include "quorient/bus/ros2.hpp"
#include "quorient/geometry/layouts.hpp"
#include "quorient/runtime/event_loop.hpp"
#include "sources.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace quorient::sensor {
namespace {

using testing::AllOf;
using testing::HasSubstr;

constexpr std::int64_t second_ns = 1'000'000'000;

/// A sensor of two IMUs on the local bus under virtual time.
class Ros2Topics : public testing::Test {
protected:
    Ros2Topics()
    {
        system::SensorSettings settings;
        settings.cluster = geometry::layout("triads-2").value();
        settings.process.bus.domain = 17;
        settings.source.ros2.emplace();
        for (const char* name : {"front", "rear"}) settings.source.ros2->imus.push_back({.topic = std::string("rt/") + name + "/data", .name = name});
        source = make_source(settings, 1).value();
        source->attach(*bus, loop);
    }

    std::vector<Notice> notices_at(std::int64_t time_ns)
    {
        clock.set(time_ns);
        while (loop.dispatch()) continue;
        std::vector<Notice> all;
        while (auto notice = source->notice()) all.push_back(*notice);
        return all;
    }

    bus::LocalHub hub;
    std::unique_ptr<bus::Bus> bus = hub.open(), robot = hub.open();
    runtime::VirtualClock clock;
    const std::atomic<bool> never_stop{false};
    runtime::EventLoop loop{*bus, clock, never_stop};
    std::unique_ptr<FrameSource> source;
};

TEST_F(Ros2Topics, without_a_publisher_are_named_once_within_five_seconds)
{
    EXPECT_TRUE(notices_at(2 * second_ns).empty());
    const auto notices = notices_at(4 * second_ns);
    ASSERT_EQ(notices.size(), 2U);
    EXPECT_THAT(notices[0].text, AllOf(HasSubstr("front: nobody publishes sensor_msgs/Imu on /front/data"), HasSubstr("ROS_DOMAIN_ID (here 17)")));
    EXPECT_EQ(notices[0].axes, 0b000111U);
    EXPECT_EQ(notices[1].axes, 0b111000U);
    EXPECT_EQ(notices[1].severity, Severity::warning_high);
    EXPECT_TRUE(notices_at(20 * second_ns).empty());
}

TEST_F(Ros2Topics, are_reported_when_their_publisher_comes_late)
{
    notices_at(4 * second_ns);
    auto publisher = robot->advertise(bus::ros2::imu("rt/rear/data", bus::ros2::offered));
    publisher.publish({.stamp_ns = second_ns});
    const auto notices = notices_at(5 * second_ns);
    ASSERT_EQ(notices.size(), 1U);
    EXPECT_EQ(notices[0].text, "rear: /rear/data is published now");
    EXPECT_EQ(notices[0].severity, Severity::info);
}

TEST_F(Ros2Topics, with_a_publisher_that_sends_nothing_are_told_from_those_without)
{
    auto publisher = robot->advertise(bus::ros2::imu("rt/rear/data", bus::ros2::offered));
    const auto notices = notices_at(4 * second_ns);
    ASSERT_EQ(notices.size(), 2U);
    EXPECT_EQ(notices[1].text, "rear: /rear/data has a publisher that sends nothing");
}

TEST_F(Ros2Topics, whose_messages_come_are_not_named)
{
    auto front = robot->advertise(bus::ros2::imu("rt/front/data", bus::ros2::offered));
    auto rear = robot->advertise(bus::ros2::imu("rt/rear/data", bus::ros2::offered));
    front.publish({.stamp_ns = second_ns});
    rear.publish({.stamp_ns = second_ns});
    EXPECT_TRUE(notices_at(second_ns).empty());
    EXPECT_TRUE(notices_at(9 * second_ns).empty());
}

}  // namespace
}  // namespace quorient::sensor
