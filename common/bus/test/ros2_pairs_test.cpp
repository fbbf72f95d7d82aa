// The ROS 2 types, written by either vendor and read by either, in both of ROS 2's profiles.

#include "pairs_scene.hpp"
#include "quorient/bus/ros2.hpp"
#include "quorient/messages/fields.hpp"

#include <gtest/gtest.h>
#include <cstring>
#include <tuple>

namespace quorient::bus {

namespace {

constexpr Qos sensor_data{.reliable = false, .depth = 5};
constexpr Qos default_profile{.reliable = true, .depth = 10};

template <std::size_t Size>
void set(Name<Size>& name, const char* text)
{
    name.fill('\0');
    std::strncpy(name.data(), text, Size - 1);
}

ros2::Imu some_imu()
{
    ros2::Imu imu;
    imu.stamp_ns = 1'700'000'000'123'456'789;
    set(imu.frame_id, "base_link");
    imu.orientation = {0.5, -0.5, 0.1, 0.7};
    imu.rate_rad_s = {0.1, 0.2, -0.3};
    imu.acceleration_m_s2 = {0, 0.25, 9.81};
    for (std::size_t i = 0; i < 9; ++i) {
        imu.orientation_covariance[i] = 0.001 * static_cast<double>(i);
        imu.rate_covariance[i] = 0.01 * static_cast<double>(i);
        imu.acceleration_covariance[i] = 0.1 * static_cast<double>(i);
    }
    return imu;
}

class Ros2Pairs : public testing::TestWithParam<std::tuple<Vendor, Vendor>> {
protected:
    /// Sends until it arrives: a best-effort sample may be lost.
    template <class Message>
    void carry(const Topic<Message>& writing, const Topic<Message>& reading, const Message& sent, Message& received)
    {
        const auto [writer, reader] = GetParam();
        const auto writer_bus = open_on_loopback(writer);
        const auto reader_bus = open_on_loopback(reader);
        auto publisher = writer_bus->advertise(writing);
        auto subscription = reader_bus->subscribe(reading);
        ASSERT_TRUE(eventually(*reader_bus, [&] { return publisher.status().matched > 0 && subscription.status().matched > 0; }));
        ASSERT_TRUE(eventually(*reader_bus, [&] { return publisher.publish(sent) && subscription.take(received); }));
    }
};

TEST_P(Ros2Pairs, carry_an_imu_to_readers_of_either_profile)
{
    for (const auto& profile : {sensor_data, default_profile}) {
        const auto sent = some_imu();
        ros2::Imu got;
        ASSERT_NO_FATAL_FAILURE(carry(ros2::imu("rt/imu/data", ros2::offered), ros2::imu("rt/imu/data", profile), sent, got));
        EXPECT_EQ(got.stamp_ns, sent.stamp_ns);
        EXPECT_EQ(got.frame_id, sent.frame_id);
        EXPECT_EQ(got.orientation, sent.orientation);
        EXPECT_EQ(got.orientation_covariance, sent.orientation_covariance);
        EXPECT_EQ(got.rate_rad_s, sent.rate_rad_s);
        EXPECT_EQ(got.rate_covariance, sent.rate_covariance);
        EXPECT_EQ(got.acceleration_m_s2, sent.acceleration_m_s2);
        EXPECT_EQ(got.acceleration_covariance, sent.acceleration_covariance);
    }
}

TEST_P(Ros2Pairs, hear_imus_of_either_profile)
{
    for (const auto& profile : {sensor_data, default_profile}) {
        ros2::Imu got;
        ASSERT_NO_FATAL_FAILURE(carry(ros2::imu("rt/imu_1/data", profile), ros2::imu("rt/imu_1/data", ros2::requested), some_imu(), got));
        EXPECT_EQ(got.rate_rad_s, some_imu().rate_rad_s);
    }
}

TEST_P(Ros2Pairs, carry_diagnostics_with_their_texts)
{
    ros2::DiagnosticArray sent;
    sent.stamp_ns = -1;  // before 1970: a negative second and a positive rest
    sent.count = 2;
    set(sent.status[1].name, "unit 1: axis 1 (G2)");
    set(sent.status[1].message, "isolated");
    set(sent.status[1].hardware_id, "unit 1");
    sent.status[1].level = static_cast<std::uint8_t>(ros2::Level::error);
    sent.status[1].value_count = 2;
    set(sent.status[1].values[1].key, "since frame");
    set(sent.status[1].values[1].value, "1600");
    ros2::DiagnosticArray got;
    ASSERT_NO_FATAL_FAILURE(
        carry(ros2::diagnostics("rt/diagnostics", ros2::offered), ros2::diagnostics("rt/diagnostics", default_profile), sent, got));
    EXPECT_EQ(got.stamp_ns, sent.stamp_ns);
    ASSERT_EQ(got.count, 2U);
    EXPECT_EQ(got.status[1].name, sent.status[1].name);
    EXPECT_EQ(got.status[1].message, sent.status[1].message);
    EXPECT_EQ(got.status[1].hardware_id, sent.status[1].hardware_id);
    EXPECT_EQ(got.status[1].level, sent.status[1].level);
    ASSERT_EQ(got.status[1].value_count, 2U);
    EXPECT_EQ(got.status[1].values[1].key, sent.status[1].values[1].key);
    EXPECT_EQ(got.status[1].values[1].value, sent.status[1].values[1].value);
    EXPECT_EQ(got.status[0].value_count, 0U);
}

INSTANTIATE_TEST_SUITE_P(Loopback, Ros2Pairs,
                         testing::Combine(testing::Values(Vendor::fastdds, Vendor::cyclonedds),
                                          testing::Values(Vendor::fastdds, Vendor::cyclonedds)),
                         [](const auto& pair) {
                             return std::string{to_string(std::get<0>(pair.param))} + "_to_" +
                                    std::string{to_string(std::get<1>(pair.param))};
                         });

}  // namespace

}  // namespace quorient::bus
