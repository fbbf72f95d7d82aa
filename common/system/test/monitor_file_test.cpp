#include "quorient/system/system.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

using namespace quorient;
using testing::HasSubstr;

namespace {

tl::expected<system::System, std::string> loaded(const std::vector<std::string>& set)
{
    return system::load(QUORIENT_SOURCE_DIR "/deploy/configurations/demo.yaml", {.dds = {}, .domain = {}, .processes = {}, .set = set});
}

std::string refusal(const std::vector<std::string>& set)
{
    const auto system = loaded(set);
    return system ? "accepted" : system.error();
}

}  // namespace

TEST(MonitorFile, a_system_without_the_section_has_no_monitor)
{
    EXPECT_FALSE(loaded({})->web_monitor);
}

TEST(MonitorFile, the_page_is_served_on_loopback_and_takes_no_orders_unless_stated)
{
    const auto system = loaded({"monitor.port=8080"});
    ASSERT_TRUE(system) << system.error();
    EXPECT_EQ(system->web_monitor->address, "127.0.0.1");
    EXPECT_EQ(system->web_monitor->port, 8080u);
    EXPECT_FALSE(system->web_monitor->allow_orders);
    EXPECT_EQ(system->web_monitor->process.node.name, "monitor");
}

TEST(MonitorFile, the_monitor_is_never_a_real_time_process_because_the_others_are)
{
    const auto system = loaded({"priority=50", "lock_memory=true", "spin=true", "monitor.port=8080"});
    ASSERT_TRUE(system) << system.error();
    EXPECT_EQ(system->voters.front().process.realtime.priority, 50);
    EXPECT_EQ(system->web_monitor->process.realtime.priority, 0);
    EXPECT_FALSE(system->web_monitor->process.realtime.lock_memory);
    EXPECT_FALSE(system->web_monitor->process.spin);
}

TEST(MonitorFile, the_sensor_does_not_wait_for_the_monitor)
{
    const auto with = loaded({"monitor.port=8080"});
    EXPECT_EQ(with->sensor.consumers, loaded({})->sensor.consumers);
}

TEST(MonitorFile, the_token_counts_from_the_folder_of_the_file_and_must_be_there)
{
    EXPECT_EQ(loaded({})->web_monitor.value_or(system::MonitorProcess{}).token_file, "");
    EXPECT_EQ(loaded({"monitor.port=0"})->web_monitor->token_file, "");
    const auto elsewhere = system::load(QUORIENT_SOURCE_DIR "/deploy/configurations/demo.yaml",
                                        {.dds = {}, .domain = {}, .processes = {}, .set = {"monitor.token_file=../token"}, .any_host = true});
    EXPECT_EQ(elsewhere->web_monitor->token_file, QUORIENT_SOURCE_DIR "/deploy/token");
    const auto why = refusal({"monitor.token_file=no-such-token"});
    EXPECT_THAT(why, HasSubstr(QUORIENT_SOURCE_DIR "/deploy/configurations/no-such-token: cannot be read: No such file"));
    EXPECT_THAT(why, HasSubstr("monitor.token_file"));
}

TEST(MonitorFile, another_host_needs_no_token_of_this_one)
{
    const auto of = [](const std::vector<std::string>& processes) {
        return system::load(QUORIENT_SOURCE_DIR "/deploy/configurations/demo.yaml",
                            {.dds = {}, .domain = {}, .processes = processes, .set = {"monitor.token_file=no-such-token"}});
    };
    EXPECT_TRUE(of({"sensor"}));
    EXPECT_FALSE(of({"monitor"}));
}

TEST(MonitorFile, says_what_is_wrong_with_the_address_the_port_and_the_keys)
{
    EXPECT_THAT(refusal({"monitor.address=everywhere"}), HasSubstr("'everywhere' is no IPv4 address"));
    EXPECT_THAT(refusal({"monitor.port=70000"}), HasSubstr("monitor.port"));
    EXPECT_THAT(refusal({"monitor.prot=8080"}), HasSubstr("did you mean 'port'?"));
    EXPECT_EQ(refusal({"monitor.address=0.0.0.0"}), "accepted");
}
