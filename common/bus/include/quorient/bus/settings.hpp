#pragma once

#include "quorient/messages/codes.hpp"

#include <cstdint>
#include <string>
#include <string_view>
#include <tl/expected.hpp>
#include <vector>

namespace quorient::bus {

/// What to do about shared memory that the settings ask for.
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
    double heartbeat_s = 0.0025;  ///< of reliable writers on a network: at most half a frame interval
    double voted_lease_s = 0.05;  ///< that a reader of `voted` asks for: at least the writers'
    bool security = false;        ///< DDS Security asked for; refused together with shared memory
    /// That a peer's address may have, ours among them: each is announced to once a second, so many addresses want a small number.
    std::uint32_t participants_per_host = 30;
};

/// @returns an error that lists the words, e.g. for "opendds".
tl::expected<Vendor, std::string> vendor_from(std::string_view word);
tl::expected<Transport, std::string> transport_from(std::string_view word);
tl::expected<SharedMemory, std::string> shared_memory_from(std::string_view word);
std::string_view to_string(Vendor vendor);
std::string_view to_string(Transport transport);

/// How often a reliable writer asks its readers what they lack. On a network as the settings say, so that a lost sample is repaired before
/// anybody's patience ends; every sample is then acknowledged by every reader. Loopback loses nothing but to a full socket buffer, and
/// there the acknowledgements would cost more than the samples: eight times as rarely, and at most 50 times a second.
double heartbeat_s(const Settings& settings);

/// How long after a sample a writer of Fast DDS takes a reader's wish to have it again for one that crossed it. With 0, its default, a timer
/// is set for every reader of every sample, and a thread woken for it: a tenth of a pipeline's CPU time at 500 Hz. On loopback half of
/// heartbeat_s(): what is lost is repaired one and a half heartbeats later at the latest. On a network 0.
double repair_pause_s(const Settings& settings);

/// Everything that can be told wrong before a participant exists: domain above 230, no such interface, a peer that is no address,
/// a transport that the vendor does not have, shared memory together with security.
/// @returns one line per problem; empty when all is well.
std::vector<std::string> problems(const Settings& settings);

}  // namespace quorient::bus
