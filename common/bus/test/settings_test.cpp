#include "quorient/bus/bus.hpp"
#include "quorient/bus/interfaces.hpp"

#include <arpa/inet.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <algorithm>
#include <cstdint>
#include <string>
#include <vector>

namespace quorient::bus {

namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

TEST(BusSettings, refuse_an_unknown_vendor_by_name)
{
    const auto vendor = vendor_from("opendds");
    ASSERT_FALSE(vendor);
    EXPECT_THAT(vendor.error(), HasSubstr("opendds"));
    EXPECT_EQ(vendor_from("fastdds"), Vendor::fastdds);
}

TEST(BusSettings, ask_for_acknowledgements_more_rarely_on_loopback_than_on_a_network)
{
    Settings settings;
    settings.heartbeat_s = 0.0025;
    settings.interface = "";
    EXPECT_DOUBLE_EQ(heartbeat_s(settings), 0.0025);
    settings.interface = "lo";
    EXPECT_DOUBLE_EQ(heartbeat_s(settings), 0.02);
    settings.heartbeat_s = 0.0005;
    EXPECT_DOUBLE_EQ(heartbeat_s(settings), 0.02);
    settings.heartbeat_s = 0.05;
    EXPECT_DOUBLE_EQ(heartbeat_s(settings), 0.1);
    settings.heartbeat_s = 0.5;
    EXPECT_DOUBLE_EQ(heartbeat_s(settings), 0.5);
}

TEST(BusSettings, repair_at_once_on_a_network_and_within_one_and_a_half_heartbeats_on_loopback)
{
    Settings settings;
    settings.interface = "";
    EXPECT_EQ(repair_pause_s(settings), 0);
    settings.interface = "lo";
    EXPECT_DOUBLE_EQ(repair_pause_s(settings), heartbeat_s(settings) / 2);
}

TEST(BusSettings, on_loopback_have_no_problem)
{
    EXPECT_THAT(problems(Settings{}), IsEmpty());
}

TEST(BusSettings, refuse_a_domain_whose_ports_do_not_exist)
{
    Settings settings;
    settings.domain = 231;
    EXPECT_THAT(problems(settings), ElementsAre(HasSubstr("231")));
    EXPECT_FALSE(open(settings));
}

TEST(BusSettings, refuse_an_interface_that_is_not_here_and_name_those_that_are)
{
    Settings settings;
    settings.interface = "nosuch0";
    EXPECT_THAT(problems(settings), ElementsAre(testing::AllOf(HasSubstr("nosuch0"), HasSubstr("lo"))));
}

TEST(BusSettings, take_an_interface_by_its_subnet)
{
    Settings settings;
    settings.interface = "127.0.0.0";
    EXPECT_THAT(problems(settings), IsEmpty());
}

TEST(BusInterfaces, of_this_host_are_told_lowest_address_first_and_without_loopback)
{
    const auto found = own_addresses();
    std::vector<std::uint32_t> numbers;
    for (const auto& address : found) {
        ASSERT_TRUE(is_ipv4_address(address));
        EXPECT_EQ(addresses_of(address), std::vector{address});
        numbers.push_back(ntohl(inet_addr(address.c_str())));
        EXPECT_NE(numbers.back() >> 24, 127U) << address;
    }
    EXPECT_TRUE(std::is_sorted(numbers.begin(), numbers.end()));
}

TEST(BusSettings, refuse_peers_that_are_names)
{
    Settings settings;
    settings.peers = {"10.0.0.1", "lane-a"};
    EXPECT_THAT(problems(settings), ElementsAre(HasSubstr("lane-a")));
}

TEST(BusSettings, refuse_shared_memory_under_security)
{
    Settings settings;
    settings.vendor = Vendor::fastdds;
    settings.transport = Transport::shared_memory;
    EXPECT_THAT(problems(settings), IsEmpty());
    settings.security.emplace();
    EXPECT_THAT(problems(settings), ElementsAre(HasSubstr("plain text")));
}

TEST(BusSettings, refuse_a_transport_of_the_other_vendor)
{
    Settings settings;
    settings.vendor = Vendor::cyclonedds;
    settings.transport = Transport::shared_memory;
    EXPECT_THAT(problems(settings), ElementsAre(HasSubstr("iceoryx")));
}

TEST(BusSettings, report_every_problem_at_once)
{
    Settings settings;
    settings.domain = 999;
    settings.interface = "nosuch0";
    settings.peers = {"lane-a"};
    EXPECT_EQ(problems(settings).size(), 3U);
}

}  // namespace

}  // namespace quorient::bus
