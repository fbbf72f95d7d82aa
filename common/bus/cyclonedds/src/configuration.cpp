#include "configuration.hpp"

#include "quorient/bus/roudi.hpp"

#include <fmt/format.h>
#include <cstdint>

namespace quorient::bus::cyclonedds {
namespace {

/// Most participants of one host and domain by RTPS's ports [RTPS 9.6.1.1]. Unicast discovery sends to each port, so it probes fewer.
constexpr std::uint32_t most_participants = 119;

/// Cyclone DDS 0.10 assumes that every node with the same MAC address shares its memory, and passes topic names to iceoryx without the
/// domain. A reader then receives the samples of other domains too. It cannot use them, does not return them, and receives nothing more
/// after 256. So the topic prefix holds the domain here, and the address (16 octets) identifies the daemon: all other nodes are reached
/// by UDP.
std::string shared_memory(std::uint32_t domain, bool shared)
{
    if (!shared) return "<SharedMemory><Enable>false</Enable></SharedMemory>";
    std::string address;
    for (const auto part : roudi_identity()) {
        for (unsigned octet = 0; octet < 8; ++octet)
            address += fmt::format("{}{:02x}", address.empty() ? "" : ":", part >> (8 * octet) & 0xffU);
    }
    return fmt::format(
        "<SharedMemory><Enable>true</Enable><Locator>{}</Locator><Prefix>quorient_{}</Prefix><LogLevel>warn</LogLevel></SharedMemory>",
        address, domain);
}

}  // namespace

std::string configuration(const Settings& settings, bool shared)
{
    std::string interface;
    if (!settings.interface.empty()) {
        const bool address = settings.interface.find('.') != std::string::npos;
        interface = fmt::format(R"(<Interfaces><NetworkInterface {}="{}" multicast="{}"/></Interfaces>)", address ? "address" : "name",
                                settings.interface, settings.peers.empty());
    }
    std::string peers;
    for (const auto& peer : settings.peers) peers += fmt::format(R"(<Peer address="{}"/>)", peer);
    const bool unicast = !settings.peers.empty();
    return fmt::format(
        "<CycloneDDS><Domain Id=\"any\"><General>{}<AllowMulticast>{}</AllowMulticast></General>"
        "<Discovery>{}<ParticipantIndex>auto</ParticipantIndex><MaxAutoParticipantIndex>{}</MaxAutoParticipantIndex></Discovery>"
        "<Internal><GenerateKeyhash>true</GenerateKeyhash><NackDelay>1ms</NackDelay>"
        "<HeartbeatInterval min=\"1ms\" minsched=\"2ms\" max=\"100ms\">{}us</HeartbeatInterval></Internal>"
        "{}</Domain></CycloneDDS>",
        interface, !unicast, unicast ? fmt::format("<Peers>{}</Peers>", peers) : std::string{},
        unicast ? settings.participants_per_host - 1 : most_participants, static_cast<long>(heartbeat_s(settings) * 1e6),
        shared_memory(settings.domain, shared));
}

}  // namespace quorient::bus::cyclonedds
