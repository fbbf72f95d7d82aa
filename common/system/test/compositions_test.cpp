#include "files.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace quorient::system {

namespace {

using testing::HasSubstr;

std::string with_compositions(const std::string& lists, const std::string& more = {})
{
    return refusal(simulation_file + more + "compose: " + lists + "\n");
}

}  // namespace

TEST(Compositions, of_any_processes_of_one_bus_are_accepted)
{
    EXPECT_EQ(with_compositions("[[fdi-a, attitude-a]]"), "accepted");
    EXPECT_EQ(with_compositions("[[fdi-a, attitude-a], [attitude-b, fdi-b]]"), "accepted");
    EXPECT_EQ(with_compositions("[[voter-1, sensor, fdi-a, attitude-a, fdi-b, attitude-b]]"), "accepted");
}

TEST(Compositions, hold_a_lane_with_both_of_its_halves_alone)
{
    const TemporaryFile file(simulation_file);
    const auto system = load(file.name());
    ASSERT_TRUE(system) << system.error();
    const auto detector = system->detector("fdi-a")->detector;
    EXPECT_TRUE(system->holds_lane(detector, {"attitude-a", "voter-1", "fdi-a"}));
    EXPECT_FALSE(system->holds_lane(detector, {"fdi-a"}));
    EXPECT_FALSE(system->holds_lane(detector, {"attitude-a"}));
    EXPECT_FALSE(system->holds_lane(detector, {"fdi-a", "attitude-b"}));
    EXPECT_FALSE(system->holds_lane(detector, {"fdi-b", "attitude-b"}));
    EXPECT_FALSE(system->holds_lane(detector, {}));
}

TEST(Compositions, without_any_every_process_runs_alone)
{
    const TemporaryFile file(simulation_file);
    const auto system = load(file.name());
    ASSERT_TRUE(system) << system.error();
    EXPECT_TRUE(system->compositions.empty());
    EXPECT_THAT(system->configuration, testing::Not(HasSubstr("compose")));
}

TEST(Compositions, stand_in_the_configuration_that_check_prints)
{
    const TemporaryFile file(simulation_file + "compose: [[fdi-a, attitude-a]]\n");
    const auto system = load(file.name());
    ASSERT_TRUE(system) << system.error();
    EXPECT_EQ(system->compositions, (std::vector<std::vector<std::string>>{{"fdi-a", "attitude-a"}}));
    EXPECT_THAT(system->configuration, HasSubstr("compose"));
    const TemporaryFile again(system->configuration, "again.yaml");
    EXPECT_EQ(load(again.name())->compositions, system->compositions);
}

TEST(Compositions, have_known_names_once)
{
    EXPECT_THAT(with_compositions("[[fdi-a, attitude-c]]"), HasSubstr("system.yaml:9:19: compose[0][1]: no process 'attitude-c'; there are voter-1"));
    EXPECT_THAT(with_compositions("[[fdi-a, fdi-a]]"), HasSubstr("compose[0][1]: 'fdi-a' stands there twice"));
    EXPECT_THAT(with_compositions("[[fdi-a, attitude-a], [fdi-b, fdi-a]]"), HasSubstr("compose[1][1]: 'fdi-a' stands in another composition, too"));
    EXPECT_THAT(with_compositions("[[fdi-a]]"), HasSubstr("compose[0]: a composition has two names at least"));
}

TEST(Compositions, have_one_bus)
{
    const auto vendors = with(simulation_file, "detector: {method: subset}", "detector: {method: subset}, dds: fastdds");
    EXPECT_THAT(refusal(vendors + "compose: [[fdi-a, fdi-b]]\n"), HasSubstr("'fdi-b' has another `dds` than 'fdi-a'"));
    EXPECT_EQ(refusal(vendors + "compose: [[fdi-b, attitude-b]]\n"), "accepted");
    EXPECT_THAT(refusal(with(simulation_file, "detector: {method: subset}", "detector: {method: subset}, priority: 50") +
                        "compose: [[fdi-a, fdi-b]]\n"),
                HasSubstr("'fdi-b' has another `priority` than 'fdi-a'"));
}

TEST(Compositions, leave_the_monitor_alone)
{
    EXPECT_THAT(with_compositions("[[fdi-a, monitor]]", "monitor: {port: 0}\n"), HasSubstr("compose[0][1]: the monitor runs alone"));
    EXPECT_EQ(with_compositions("[[fdi-a, attitude-a]]", "monitor: {port: 0}\n"), "accepted");
}

TEST(Compositions, are_refused_under_security)
{
    EXPECT_THAT(with_compositions("[[fdi-a, attitude-a]]", "security: {level: sign, directory: nowhere}\n"),
                HasSubstr("compose[0][0]: a secured process runs alone: one participant has one certificate"));
}

}  // namespace quorient::system
