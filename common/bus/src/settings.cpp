#include "quorient/bus/settings.hpp"

#include "quorient/bus/interfaces.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <algorithm>
#include <array>
#include <utility>

namespace quorient::bus {

namespace {

constexpr std::array vendors{std::pair{Vendor::fastdds, "fastdds"}, std::pair{Vendor::cyclonedds, "cyclonedds"},
                             std::pair{Vendor::local, "local"}};
constexpr std::array transports{std::pair{Transport::udp, "udp"}, std::pair{Transport::shared_memory, "shm"},
                                std::pair{Transport::iceoryx, "iceoryx"}, std::pair{Transport::in_process, "in-process"}};

constexpr std::array shared_memory_choices{std::pair{SharedMemory::required, "required"}, std::pair{SharedMemory::preferred, "preferred"},
                                           std::pair{SharedMemory::off, "off"}};

constexpr double loopback_ratio = 8;
constexpr double shortest_loopback_s = 0.02;  // above 200 Hz the answers of nine processes would fill two cores
constexpr double longest_loopback_s = 0.1;    // a sample lost to a full buffer, at the end of a stream

constexpr double highest_domain = 230;  // above it the RTPS ports leave the range of UDP [RTPS 9.6.1.1]

constexpr std::array<settings::Setting<Settings>, 2> record{{
    {"domain", &Settings::domain, "", {.lowest = 0, .highest = highest_domain}, "DDS domain."},
    {"participants_per_host",
     &Settings::participants_per_host,
     "",
     {.lowest = 1, .highest = 60},
     "Participants that are looked for at each address of `peers`, ours included. Each costs a packet a second."},
}};

}  // namespace

tl::expected<Vendor, std::string> vendor_from(std::string_view word)
{
    for (const auto& [vendor, name] : vendors) {
        if (word == name) return vendor;
    }
    return tl::make_unexpected(fmt::format("unknown DDS vendor '{}'; known are fastdds, cyclonedds and local", word));
}

tl::expected<Transport, std::string> transport_from(std::string_view word)
{
    for (const auto& [transport, name] : transports) {
        if (word == name && transport != Transport::in_process) return transport;
    }
    return tl::make_unexpected(fmt::format("unknown transport '{}'; known are udp, shm (Fast DDS) and iceoryx (Cyclone DDS)", word));
}

std::vector<std::pair<std::string, Vendor>> vendor_words()
{
    std::vector<std::pair<std::string, Vendor>> words;
    words.reserve(vendors.size());
    for (const auto& [vendor, name] : vendors) words.emplace_back(name, vendor);
    return words;
}

std::vector<std::pair<std::string, Transport>> transport_words()
{
    std::vector<std::pair<std::string, Transport>> words;
    words.reserve(transports.size());
    for (const auto& [transport, name] : transports)
        if (transport != Transport::in_process) words.emplace_back(name, transport);
    return words;
}

std::vector<std::pair<std::string, SharedMemory>> shared_memory_words()
{
    std::vector<std::pair<std::string, SharedMemory>> words;
    words.reserve(shared_memory_choices.size());
    for (const auto& [choice, name] : shared_memory_choices) words.emplace_back(name, choice);
    return words;
}

std::string_view to_string(Vendor vendor)
{
    for (const auto& [known, name] : vendors) {
        if (known == vendor) return name;
    }
    return "unknown";
}

std::string_view to_string(Transport transport)
{
    for (const auto& [known, name] : transports) {
        if (known == transport) return name;
    }
    return "unknown";
}

double heartbeat_s(const Settings& settings)
{
    if (!is_loopback(settings.interface)) return settings.heartbeat_s;
    return std::max(settings.heartbeat_s, std::clamp(loopback_ratio * settings.heartbeat_s, shortest_loopback_s, longest_loopback_s));
}

double repair_pause_s(const Settings& settings)
{
    return is_loopback(settings.interface) ? heartbeat_s(settings) / 2 : 0;
}

settings::Record<Settings> bus_record()
{
    return record;
}

std::vector<Finding> findings(const Settings& settings)
{
    std::vector<Finding> found;
    if (settings.vendor == Vendor::local) return found;
    if (settings.domain > highest_domain)
        found.push_back({"domain", fmt::format("DDS domain {} is above {}", settings.domain, highest_domain)});
    if (!settings.interface.empty() && addresses_of(settings.interface).empty())
        found.push_back({"interface", fmt::format("no network interface '{}' with an IPv4 address is up; there are {}", settings.interface,
                                                  fmt::join(interface_names(), ", "))});
    for (const auto& peer : settings.peers) {
        if (!is_ipv4_address(peer))
            found.push_back({"peers", fmt::format("peer '{}' is not an IPv4 address (a name would block discovery for seconds)", peer)});
    }
    const bool shared = settings.transport == Transport::shared_memory || settings.transport == Transport::iceoryx;
    if (settings.transport == Transport::shared_memory && settings.vendor != Vendor::fastdds)
        found.push_back({"transport", "transport shm belongs to fastdds; cyclonedds has iceoryx"});
    if (settings.transport == Transport::iceoryx && settings.vendor != Vendor::cyclonedds)
        found.push_back({"transport", "transport iceoryx belongs to cyclonedds; fastdds has shm"});
    if (shared && settings.security)
        found.push_back(
            {"security", "shared memory would carry what DDS Security encrypts in plain text: use transport udp, or no security"});
    return found;
}

std::vector<std::string> problems(const Settings& settings)
{
    std::vector<std::string> texts;
    for (auto& finding : findings(settings)) texts.push_back(std::move(finding.text));
    return texts;
}

}  // namespace quorient::bus
