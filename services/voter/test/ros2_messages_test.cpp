#include "ros2_messages.hpp"

#include "quorient/messages/codes.hpp"
#include "quorient/messages/meaning.hpp"
#include "quorient/messages/name.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>
#include <cmath>

namespace quorient::voter {

namespace {

using bus::ros2::DiagnosticArray;
using bus::ros2::Level;

/// Three gyros along the body's axes and one on their diagonal.
ClusterDescription description()
{
    ClusterDescription described;
    described.interval_s = 0.01;
    described.axis_count = described.instrument_count = 4;
    described.axis[0] = {1, 0, 0};
    described.axis[1] = {0, 1, 0};
    described.axis[2] = {0, 0, 1};
    described.axis[3] = {std::sqrt(1.0 / 3), std::sqrt(1.0 / 3), std::sqrt(1.0 / 3)};
    for (std::size_t axis = 0; axis < 4; ++axis) {
        described.sigma[axis] = 1e-5;
        described.instrument[axis] = static_cast<std::uint8_t>(axis);
        copy_text(fmt::format("G{}", axis + 1), described.instrument_name[axis]);
    }
    return described;
}

VotedAttitude voted()
{
    VotedAttitude attitude;
    attitude.epoch = 5;
    attitude.sequence = 100;
    attitude.unit = 1;
    attitude.voter = 1;
    attitude.primary_lane = 2;
    attitude.vouching_mask = 0b010;
    attitude.excluded_why = {octet(LaneExclusion::silent), 0, octet(LaneExclusion::disagrees)};
    attitude.used_mask = 0b1011;
    attitude.isolated_mask = 0b0100;
    attitude.excluded_from[2] = 77;
    attitude.attitude = {0.5, 0.5, -0.5, 0.5};
    attitude.rate_rad_s = {0.1, -0.2, 0.3};
    attitude.angle_sigma_rad = 3e-4;
    attitude.mode = octet(AttitudeMode::normal);
    attitude.level = octet(VoteLevel::degraded);
    return attitude;
}

TEST(Ros2Imu, covariance_of_orthogonal_gyros_is_that_of_each_gyro)
{
    const auto covariance = rate_covariance(description(), 0b0111);
    for (std::size_t i = 0; i < 9; ++i) EXPECT_NEAR(covariance[i], i % 4 == 0 ? 1e-6 : 0, 1e-15) << i;  // (1e-5 rad / 0.01 s)^2
}

TEST(Ros2Imu, a_fourth_gyro_makes_the_rate_along_it_better_and_none_across)
{
    const auto covariance = rate_covariance(description(), 0b1111);
    // (I + d d') ^-1 = I - d d' / 2
    EXPECT_NEAR(covariance[0], 1e-6 * (1 - 1.0 / 6), 1e-15);
    EXPECT_NEAR(covariance[1], -1e-6 / 6, 1e-15);
}

TEST(Ros2Imu, does_not_state_a_covariance_that_nobody_knows)
{
    EXPECT_EQ(rate_covariance(description(), 0b0011), (std::array<double, 9>{}));
    auto noiseless = description();
    noiseless.sigma.fill(0);
    EXPECT_EQ(rate_covariance(noiseless, 0b1111), (std::array<double, 9>{}));
}

TEST(Ros2Imu, carries_attitude_rate_and_a_third_of_the_angle_variance_about_each_axis)
{
    const auto imu = to_imu(voted(), rate_covariance(description(), 0b0111));
    EXPECT_EQ(imu.orientation, voted().attitude);
    EXPECT_EQ(imu.rate_rad_s, voted().rate_rad_s);
    EXPECT_NEAR(imu.orientation_covariance[0] + imu.orientation_covariance[4] + imu.orientation_covariance[8], 9e-8, 1e-20);
    EXPECT_EQ(imu.acceleration_covariance[0], -1) << "an attitude has no acceleration";
}

TEST(Ros2Imu, says_that_there_is_no_orientation_where_it_is_lost)
{
    auto lost = voted();
    lost.level = octet(VoteLevel::lost);
    EXPECT_EQ(to_imu(lost, {}).orientation_covariance[0], -1);
    lost = voted();
    lost.mode = octet(AttitudeMode::lost);
    EXPECT_EQ(to_imu(lost, {}).orientation_covariance[0], -1);
    EXPECT_GT(to_imu(voted(), {}).orientation_covariance[0], 0);
}

TEST(HostTime, keeps_the_instruments_spacing_and_is_never_later_than_arrival)
{
    HostTime time;
    auto sample = voted();
    std::int64_t last = 0;
    for (std::int64_t i = 0; i < 100; ++i) {
        sample.sample_time_ns = i * 10'000'000;
        const std::int64_t arrival = 1'700'000'000'000'000'000 + sample.sample_time_ns + (i % 7) * 100'000;  // jitter
        const auto stamp = time.of(sample, arrival);
        EXPECT_LE(stamp, arrival);
        EXPECT_TRUE(i == 0 || stamp - last == 10'000'000) << i;
        last = stamp;
    }
    sample.epoch = 6;
    sample.sample_time_ns = 10'000'000;
    EXPECT_EQ(time.of(sample, 1'800'000'000'000'000'000), 1'800'000'000'000'000'000) << "a new epoch has a clock of its own";
}

std::string find(const DiagnosticArray& array, const std::string& name, Level& level)
{
    for (std::size_t i = 0; i < array.count; ++i) {
        if (text_of(array.status[i].name) != "quorient: " + name) continue;
        level = static_cast<Level>(array.status[i].level);
        return std::string{text_of(array.status[i].message)};
    }
    return "absent";
}

TEST(Ros2Diagnostics, tell_of_every_axis_lane_and_voter)
{
    const auto described = description();
    DiagnosticArray array;
    to_diagnostics(voted(), &described, {{1, 1, "a"}, {2, 2, "b"}, {3, 3, "c"}}, {{1, true}, {2, true}, {3, false}}, array);
    struct {
        const char* name;
        const char* message;
        Level level;
    } const expected[] = {
        {"axis 0 (G1)", "in use", Level::ok},      {"axis 2 (G3)", "isolated", Level::error}, {"lane b", "primary", Level::ok},
        {"voter 1", "owns the output", Level::ok}, {"voter 2", "stands by", Level::ok},       {"voter 3", "silent", Level::error},
    };
    Level level{};
    for (const auto& [name, message, wanted] : expected) {
        EXPECT_EQ(find(array, name, level), message) << name;
        EXPECT_EQ(level, wanted) << name;
    }
    find(array, "lane a", level);
    EXPECT_EQ(level, Level::error);
    find(array, "lane c", level);
    EXPECT_EQ(level, Level::warning);
    find(array, "attitude", level);
    EXPECT_EQ(level, Level::warning);
    EXPECT_EQ(array.count, 1U + 3U + 3U + 4U);
}

TEST(Ros2Diagnostics, do_not_overflow_with_what_a_foreign_publisher_describes)
{
    auto described = description();
    described.axis_count = 255;
    described.instrument.fill(255);
    DiagnosticArray array;
    to_diagnostics(voted(), &described, std::vector<voting::LaneSettings>(8), std::vector<VoterPresence>(40), array);
    EXPECT_EQ(array.count, array.status.size());
}

}  // namespace

}  // namespace quorient::voter
