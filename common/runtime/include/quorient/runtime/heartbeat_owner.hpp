#pragma once

#include "quorient/runtime/heartbeat.hpp"

#include <cstdint>
#include <string>
#include <vector>

namespace quorient::runtime {

/// The system that this process is part of. Two systems of a host may call their processes alike; within a unit of a domain names differ.
struct HeartbeatOwner {
    std::string system;  ///< the system file's `name`
    std::uint32_t domain = 0;
    std::uint32_t unit = 0;
};

/// States it once for the process, before its first heartbeat is opened.
void set_heartbeat_owner(HeartbeatOwner owner);

/// A service of this host.
struct Pulse {
    std::string service;
    HeartbeatOwner owner;
    Beat beat;  ///< frames 0: none was handled yet
};

/// The last beats of all services that left one, by name, domain and unit. Files that are no heartbeats are passed over.
std::vector<Pulse> read_pulses();

}  // namespace quorient::runtime
