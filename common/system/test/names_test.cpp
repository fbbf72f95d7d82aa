#include "files.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace quorient::system {

namespace {

using testing::HasSubstr;

std::string with_lanes(const std::string& lanes)
{
    return refusal(with(simulation_file, "lanes:\n  - {name: a, detector: {method: glt}}\n  - {name: b, detector: {method: subset}}\n",
                        "lanes: " + lanes + "\n"));
}

std::string with_voters(const std::string& voters)
{
    return refusal(with(simulation_file, "voters:\n  - {name: voter-1}\n", "voters: " + voters + "\n"));
}

}  // namespace

TEST(Names, of_lanes_differ)
{
    EXPECT_EQ(with_lanes("[{name: a}, {name: b}]"), "accepted");
    EXPECT_THAT(with_lanes("[{name: a}, {name: a}]"), HasSubstr("system.yaml:4:27: lanes[1].name: 'a' is taken by lanes[0]"));
}

TEST(Names, of_voters_differ)
{
    EXPECT_EQ(with_voters("[{name: v}, {name: w}]"), "accepted");
    EXPECT_THAT(with_voters("[{name: v}, {name: v}]"), HasSubstr("system.yaml:7:28: voters[1].name: 'v' is taken by voters[0]"));
    EXPECT_THAT(with_voters("[{name: voter-2}, {}]"), HasSubstr("voters[1].name: 'voter-2' is taken by voters[0]"));
}

TEST(Names, of_voters_are_not_those_of_other_processes)
{
    EXPECT_THAT(with_voters("[{name: sensor}]"), HasSubstr("voters[0].name: 'sensor' is taken by the process that publishes frames"));
    EXPECT_THAT(with_voters("[{name: fdi-a}]"), HasSubstr("voters[0].name: 'fdi-a' is taken by the detector of lanes[0]"));
    EXPECT_THAT(with_voters("[{name: attitude-b}]"), HasSubstr("voters[0].name: 'attitude-b' is taken by the integrator of lanes[1]"));
    EXPECT_THAT(with_voters("[{name: monitor}]"), HasSubstr("voters[0].name: 'monitor' is taken"));
    EXPECT_THAT(with_voters("[{name: roudi}]"), HasSubstr("voters[0].name: 'roudi' is taken"));
    EXPECT_EQ(with_voters("[{name: fdi-c}]"), "accepted");
}

TEST(Names, of_the_monitor_is_its_own)
{
    EXPECT_EQ(refusal(simulation_file + "monitor: {port: 0}\n"), "accepted");
    EXPECT_EQ(refusal(simulation_file + "monitor: {port: 0, name: page}\n"), "accepted");
    EXPECT_THAT(refusal(simulation_file + "monitor: {name: fdi-a}\n"), HasSubstr("monitor.name: 'fdi-a' is taken by the detector of lanes[0]"));
    EXPECT_THAT(refusal(simulation_file + "monitor: {name: a/b}\n"), HasSubstr("monitor.name: must not hold '/'"));
}

TEST(Names, of_processes_can_be_names_of_files)
{
    EXPECT_THAT(with_lanes("[{name: ../a}]"), HasSubstr("lanes[0].name: must not hold '/'"));
    EXPECT_THAT(with_lanes("[{name: .a}]"), HasSubstr("lanes[0].name: must not begin with '.'"));
    EXPECT_THAT(with_lanes("[{name: \"a\\nb\"}]"), HasSubstr("lanes[0].name: must not hold control characters"));
    EXPECT_THAT(with_voters("[{name: a/b}]"), HasSubstr("voters[0].name: must not hold '/'"));
    EXPECT_EQ(with_voters("[{name: 'voter 1 (main)'}]"), "accepted");
}

TEST(Names, fit_into_messages)
{
    const std::string of_22 = "a-name-of-22-letters--";
    EXPECT_EQ(with_lanes("[{name: " + of_22 + "}]"), "accepted");
    EXPECT_THAT(with_lanes("[{name: " + of_22 + "x}]"), HasSubstr("has more than 22 characters"));
    EXPECT_EQ(with_voters("[{name: " + of_22 + "123456789}]"), "accepted");
    EXPECT_THAT(with_voters("[{name: " + of_22 + "1234567890}]"), HasSubstr("has more than 31 characters"));
    EXPECT_THAT(refusal(with(simulation_file, "id: 1", "id: 1, name: " + of_22 + "1234567890")), HasSubstr("unit.name: "));
    EXPECT_THAT(refusal(with(ros2_file, "front", "sixteen-letters-")),
                HasSubstr("source.imus[0].name: 'sixteen-letters-' has more than 15"));
}

TEST(Names, of_imus_differ)
{
    EXPECT_EQ(refusal(ros2_file), "accepted");
    EXPECT_THAT(refusal(with(ros2_file, "rear", "front")),
                HasSubstr("system.yaml:5:54: source.imus[1].name: 'front' is taken by source.imus[0]"));
    EXPECT_THAT(refusal(with(ros2_file, "rear", "IMU3")), HasSubstr("source.imus[2].name: 'IMU3' is taken by source.imus[1]"));
    EXPECT_THAT(refusal(with(ros2_file, "/b", "/a")), HasSubstr("source.imus[1].topic: two IMUs"));
}

TEST(Names, of_channels_differ)
{
    EXPECT_EQ(refusal(with(vessel_file, "vessel_rates", "vessel_rates, channels: [sway, yaw]")), "accepted");
    EXPECT_THAT(refusal(with(vessel_file, "vessel_rates", "vessel_rates, channels: [yaw, yaw]")),
                HasSubstr("unit.channels[1]: 'yaw' is taken by channel 0"));
}

}  // namespace quorient::system
