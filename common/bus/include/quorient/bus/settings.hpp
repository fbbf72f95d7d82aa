#pragma once

#include "quorient/bus/security.hpp"
#include "quorient/messages/codes.hpp"
#include "quorient/settings/setting.hpp"

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <tl/expected.hpp>
#include <utility>
#include <vector>

namespace quorient::bus {

/// What to do if shared memory is requested and not available.
enum class SharedMemory : std::uint8_t {
    required,   ///< refuse to start without it
    preferred,  ///< UDP where it is not there, with an alarm
    off,        ///< UDP, with an alarm: for a process that comes back after the others' shared memory was lost
};

/// How one process joins the bus.
struct Settings {
    Vendor vendor = Vendor::cyclonedds;
    std::uint32_t domain = 0;
    std::string interface = "lo";          ///< name, IPv4 address, or subnet base address; empty = the vendor's choice
    std::vector<std::string> peers;        ///< IPv4 addresses for unicast discovery; empty = multicast
    Transport transport = Transport::udp;  ///< udp, shared_memory (Fast DDS) or iceoryx (Cyclone DDS)
    SharedMemory shared_memory = SharedMemory::required;
    std::string participant;      ///< name shown to other tools
    double heartbeat_s = 0.0025;  ///< for reliable writers on a network: at most half a frame interval
    double voted_lease_s = 0.05;  ///< lease requested by readers of `voted`: at least the writers'
    std::optional<SecurityFiles> security;  ///< plain DDS without; refused together with shared memory
    std::uint32_t participants_per_host = 30;
};

/// Its numbers, and what each means.
settings::Record<Settings> bus_record();

/// @returns an error that lists the words, e.g. for "opendds".
tl::expected<Vendor, std::string> vendor_from(std::string_view word);
tl::expected<Transport, std::string> transport_from(std::string_view word);

/// The words of files, each with what it means.
std::vector<std::pair<std::string, Vendor>> vendor_words();
std::vector<std::pair<std::string, Transport>> transport_words();
std::vector<std::pair<std::string, SharedMemory>> shared_memory_words();

std::string_view to_string(Vendor vendor);
std::string_view to_string(Transport transport);

/// Heartbeat period of a reliable writer. On a network it is that of the settings, so that a lost sample is repaired before any consumer's
/// patience ends; every reader then acknowledges every sample. Loopback loses samples only to a full socket buffer, and acknowledgements
/// would cost more than the samples. There the period is eight times as long, and at least 20 ms.
double heartbeat_s(const Settings& settings);

/// Fast DDS: how long after a send a NACK is ignored because it may have crossed the sample. With its default of 0 a timer is set for every
/// reader of every sample, and a thread wakes up for it. On loopback this is half of heartbeat_s(): a lost sample is repaired one and a
/// half heartbeats later at the latest. On a network it is 0.
double repair_pause_s(const Settings& settings);

/// Every problem that can be found before a participant exists: domain above 230, an unknown interface, a peer that is no address,
/// a transport that the vendor does not have, shared memory together with security.
/// @returns one line per problem; empty when all is well.
std::vector<std::string> problems(const Settings& settings);

/// A problem and the setting that has it, by its key in files.
struct Finding {
    std::string_view key;
    std::string text;
};

/// The same, each with its setting.
std::vector<Finding> findings(const Settings& settings);

}  // namespace quorient::bus
