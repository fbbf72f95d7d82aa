#pragma once

#include <cstddef>
#include <cstdint>
#include <string>

namespace quorient::bus {

/// Whether iceoryx's daemon listens on this host. Asked before anything else: Cyclone DDS would wait 60 s for a daemon that is not
/// there, deaf to SIGTERM, and then abort.
bool roudi_answers();

/// Tells one life of the daemon from another; 0 when it does not answer.
std::uint64_t roudi_life();

/// The daemon's configuration (TOML): memory pools for all hot topics of a system.
/// @param writers, readers  endpoints in shared memory, of all processes together; each may hold a topic's whole history.
std::string roudi_configuration(std::size_t writers, std::size_t readers);

}  // namespace quorient::bus
