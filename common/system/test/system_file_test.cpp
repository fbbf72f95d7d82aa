#include "files.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace quorient::system {

namespace {

using testing::AllOf;
using testing::HasSubstr;
using testing::Not;
using testing::StartsWith;

}  // namespace

TEST(SystemFile, reports_all_its_problems_at_once_in_their_order)
{
    EXPECT_EQ(refusal("domain: 231\n"
                      "unit: {layuot: cone-6}\n"
                      "source: {rate_hz: fast, seed: -1}\n"
                      "lanes:\n"
                      "  - {name: a, detector: {pfa: 1}}\n"
                      "voters: [{name: v, priority: 100}]\n"
                      "voting: {patience: 0, level_window: 33}\n"),
              "system.yaml:1:9: domain: must be 0 to 230, got 231\n"
              "system.yaml:2:8: unknown key 'layuot' in unit; did you mean 'layout'?\n"
              "system.yaml:3:9: source.kind: a simulation needs unit.layout or unit.axes\n"
              "system.yaml:3:19: source.rate_hz: expected a number [Hz], got 'fast'\n"
              "system.yaml:3:31: source.seed: expected a whole number, got '-1'\n"
              "system.yaml:5:31: lanes[0].detector.pfa: must be above 0 and below 1, got 1\n"
              "system.yaml:6:30: voters[0].priority: must be 0 to 99, got 100\n"
              "system.yaml:7:20: voting.patience: must be above 0 and at most 10 [intervals], got 0\n"
              "system.yaml:7:37: voting.level_window: must be 1 to 32 [frames], got 33\n"
              "9 problems, nothing started");
}

TEST(SystemFile, is_refused_for_a_key_that_stands_there_twice)
{
    EXPECT_THAT(refusal("domain: 1\n" + simulation_file), HasSubstr("system.yaml:2:1: domain: stands here a second time, first in line 1"));
    EXPECT_THAT(refusal(with(simulation_file, "id: 1", "id: 1, id: 2")), HasSubstr("system.yaml:2:15: unit.id: stands here a second time"));
    EXPECT_THAT(refusal(with(simulation_file, "method: glt", "method: glt, method: mean")),
                HasSubstr("lanes[0].detector.method: stands here"));
}

TEST(SystemFile, suggests_range_deg_s_for_range)
{
    EXPECT_THAT(refusal(with(simulation_file, "id: 1", "id: 1, range: 300")),
                HasSubstr("unknown key 'range' in unit; did you mean 'range_deg_s'?"));
}

TEST(SystemFile, is_refused_for_tabs_and_directories_in_words_that_say_so)
{
    EXPECT_THAT(refusal(with(simulation_file, "  - {name: b", "\t- {name: b")),
                StartsWith("system.yaml:6:1: a tab indents this line: YAML wants spaces\n"));
    EXPECT_THAT(load(testing::TempDir()).error(), HasSubstr("is a directory, expected a file"));
}

TEST(SystemFile, names_the_command_line_as_the_place_of_what_was_set_there)
{
    EXPECT_THAT(refusal(simulation_file, {.set = {"source.speed=0", "lanes.a.detector.pfa=2", "lanes.z.name=1", "nonsense"}}),
                AllOf(HasSubstr("--set source.speed=0: source.speed: must be above 0, got 0"),
                      HasSubstr("--set lanes.a.detector.pfa=2: lanes[0].detector.pfa: must be above 0 and below 1, got 2"),
                      HasSubstr("--set lanes.z.name=1: there is no item 'z' in 'lanes'"), HasSubstr("4 problems")));
}

TEST(SystemFile, reports_what_the_bus_refuses_at_the_key_that_says_so)
{
    EXPECT_THAT(refusal("interface: nosuch0\n" + simulation_file),
                AllOf(StartsWith("system.yaml:1:12: interface: no network interface 'nosuch0'"), HasSubstr("1 problem,")));
    EXPECT_THAT(refusal(with(simulation_file, "name: b,", "name: b, interface: nosuch0,")),
                HasSubstr("system.yaml:6:26: lanes[1].interface: no network"));
    EXPECT_THAT(refusal(with(simulation_file, "name: voter-1", "name: voter-1, transport: shm")),
                HasSubstr("system.yaml:8:32: voters[0].transport: transport shm belongs to fastdds"));
    EXPECT_THAT(refusal("peers: [lane-a]\n" + simulation_file), HasSubstr("system.yaml:1:8: peers: peer 'lane-a' is not an IPv4 address"));
}

TEST(SystemFile, may_name_networks_of_other_hosts)
{
    const auto text = with(simulation_file, "name: b,", "name: b, interface: nosuch0,");
    EXPECT_EQ(refusal(text, {.processes = {"fdi-a"}}), "accepted");
    EXPECT_EQ(refusal(text, {.any_host = true}), "accepted");
    EXPECT_THAT(refusal(text, {.processes = {"fdi-b"}}), HasSubstr("nosuch0"));
    EXPECT_THAT(refusal(text, {.processes = {"attitude-b"}}), HasSubstr("nosuch0"));
}

TEST(SystemFile, sets_every_setting_of_voting_and_integration)
{
    const auto system =
        loaded(simulation_file + "voting: {disagreement_frames: 4, coasting_interval_s: 0.1, coasting_rate_rad_s: 0.3, listen_s: 1}\n",
               {.set = {"lanes.a.integrator={initial_sigma_rad: 0.01}"}});
    ASSERT_TRUE(system) << system.error();
    const auto& voting = system->voters.front().voting;
    EXPECT_EQ(voting.disagreement_frames, 4U);
    EXPECT_EQ(voting.coasting_interval_s, 0.1);
    EXPECT_EQ(voting.coasting_rate_rad_s, 0.3);
    EXPECT_EQ(voting.listen_s, 1);
    EXPECT_EQ(system->lanes[0].integrator.integration.initial_sigma_rad, 0.01);
}

TEST(SystemFile, takes_the_sensors_own_way_of_waiting)
{
    EXPECT_TRUE(loaded(simulation_file + "sensor: {spin: true}\n")->sensor.process.spin);
    EXPECT_FALSE(loaded(simulation_file)->sensor.process.spin);
}

TEST(SystemFile, is_refused_for_keys_that_nothing_would_read)
{
    EXPECT_THAT(refusal(with(log_file, "data.csv", "data.csv, noise_rad: 1.0e-5")), HasSubstr("source.noise_rad: has no axes to hold for"));
    EXPECT_THAT(refusal(with(ros2_file, "rate_hz", "speed")), HasSubstr("nothing to replace"));
    EXPECT_THAT(refusal(with(ros2_file, "kind: ros2_imu", "kind: ros2_imu\n  speed: 2")), HasSubstr("unknown key 'speed' in source"));
    EXPECT_THAT(refusal(accelerometer_file + "voters: [{name: v}]\n"), HasSubstr("voters: accelerometers give no attitude"));
    EXPECT_THAT(refusal(vessel_file + "ros2: {}\n"), HasSubstr("ros2: a vessel's rates give no attitude"));
    EXPECT_THAT(refusal(with(simulation_file, "layout: cone-6", "layout: cone-6, axes: [[1, 0, 0], [0, 1, 0], [0, 0, 1]]")),
                HasSubstr("unit.axes: states the axes, as unit.layout does"));
}

TEST(SystemFile, states_the_range_of_every_axis)
{
    const auto range = [](const std::string& text) { return loaded(text)->sensor.cluster->range(0); };
    EXPECT_NEAR(range(with(simulation_file, "id: 1", "id: 1, range_deg_s: 180")), 3.14159265358979, 1e-14);
    EXPECT_NEAR(range(with(ros2_file, "id: 1", "id: 1, range_deg_s: 180")), 3.14159265358979, 1e-14);
    EXPECT_EQ(range(with(accelerometer_file, "id: 1", "id: 1, range_m_s2: 160")), 160);
    EXPECT_NEAR(loaded(with(log_file, "id: 1", "id: 1, range_deg_s: 180"))->sensor.range, 3.14159265358979, 1e-14);
}

TEST(SystemFile, of_accelerometers_describes_detectors_alone)
{
    const auto system = loaded(accelerometer_file);
    ASSERT_TRUE(system) << system.error();
    EXPECT_FALSE(system->has_attitude());
    EXPECT_EQ(system->sensor.consumers, std::vector<std::string>{"fdi-a"});
    EXPECT_EQ(system->sensor.cluster->kind, SensorKind::accelerometer);
}

TEST(SystemFile, refuses_what_a_lane_could_not_do)
{
    EXPECT_THAT(refusal(with(simulation_file, "method: glt", "method: vector")), HasSubstr("lanes[0].detector: "));
    EXPECT_THAT(refusal(with(simulation_file, "method: glt", "method: gtl")),
                HasSubstr("lanes[0].detector.method: unknown method 'gtl'; there are auto, "));
    EXPECT_THAT(refusal(with(simulation_file, "method: glt}", "method: glt}, integrator: {algorithm: widow-10}")),
                HasSubstr("lanes[0].integrator.algorithm: "));
    EXPECT_THAT(refusal(with(simulation_file, "method: glt}", "method: glt}, integrator: {history_s: 1251}")),
                HasSubstr("lanes[0].integrator.history_s: must be at most 1250 [s] at this rate, got 1251"));
    EXPECT_THAT(refusal(with(simulation_file, "method: glt", "confirm_required: 4")), HasSubstr("lanes[0].detector.confirm_required: "));
}

}  // namespace quorient::system
