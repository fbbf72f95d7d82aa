#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <string>

namespace quorient::bus {

/// Whether iceoryx's daemon listens on this host. Asked before anything else: Cyclone DDS would wait 60 s for a daemon that is not
/// there, deaf to SIGTERM, and then abort.
bool roudi_answers();

/// Why it does not, and what to do about it; empty when it does.
std::string roudi_silence();

/// Tells one life of the daemon from another; 0 when it does not answer.
std::uint64_t roudi_life();

/// The same in all processes that share this life of the daemon, another one with any other daemon of any host: the host's boot, and the life.
std::array<std::uint64_t, 2> roudi_identity();

/// What a sample takes in a memory pool, in bytes: with iceoryx's and Cyclone DDS's headers, as the pools are sized.
std::size_t chunk_size(std::size_t sample);

/// The daemon's configuration (TOML): memory pools for all hot topics of a system.
/// @param writers, readers  endpoints in shared memory, of all processes together; each may hold a topic's whole history.
std::string roudi_configuration(std::size_t writers, std::size_t readers);

/// What the daemon takes of /dev/shm with that configuration, in bytes.
std::uintmax_t roudi_memory(std::size_t writers, std::size_t readers);

/// Of /dev/shm, in bytes. Who writes beyond it is ended by the kernel (SIGBUS), so it is asked before anybody shares memory.
std::uintmax_t free_shared_memory();

}  // namespace quorient::bus
