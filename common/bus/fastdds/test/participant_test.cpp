#include "../src/participant.hpp"

#include <gtest/gtest.h>
#include <unistd.h>
#include <set>

namespace quorient::bus::fastdds {
namespace {

/// Where one life of a process receives in shared memory.
std::set<std::uint32_t> ports_in_memory()
{
    Settings settings;
    settings.vendor = Vendor::fastdds;
    settings.domain = 120 + static_cast<std::uint32_t>(::getpid()) % 100;
    settings.transport = Transport::shared_memory;
    Peers peers{false};
    auto* participant = join(settings, peers);
    if (!participant) return {};
    std::set<std::uint32_t> ports;
    const auto wire = participant->get_qos().wire_protocol();
    for (const auto* addresses : {&wire.builtin.metatrafficUnicastLocatorList, &wire.default_unicast_locator_list})
        for (const auto& address : *addresses)
            if (address.kind == shared_memory_locator) ports.insert(address.port);
    dds::DomainParticipantFactory::get_instance()->delete_participant(participant);
    return ports;
}

TEST(Participant, receives_at_other_ports_of_shared_memory_in_its_next_life)
{
    const auto first = ports_in_memory();
    const auto second = ports_in_memory();
    EXPECT_EQ(first.size(), 2U);
    EXPECT_EQ(second.size(), 2U);
    for (const auto port : second) EXPECT_FALSE(first.contains(port)) << port;
}

}  // namespace
}  // namespace quorient::bus::fastdds
