#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <string>

namespace quorient::bus {

/// Whether iceoryx's daemon listens on this host. Checked first: Cyclone DDS would wait 60 s for a missing daemon, ignore SIGTERM, and
/// then abort.
bool roudi_answers();

/// Why it does not, and what to do about it; empty when it does.
std::string roudi_silence();

/// Distinguishes one run of the daemon from another; 0 when it does not answer.
std::uint64_t roudi_life();

/// Identifies this run of the daemon: the same in all processes that share it, different for any other daemon on any host. It consists of
/// the host's boot and the run.
std::array<std::uint64_t, 2> roudi_identity();

/// Size of a sample in a memory pool, in bytes, with iceoryx's and Cyclone DDS's headers.
std::size_t chunk_size(std::size_t sample);

/// The daemon's configuration (TOML): memory pools for all hot topics of a system.
/// @param writers, readers  endpoints in shared memory, of all processes together; each may hold a topic's whole history.
std::string roudi_configuration(std::size_t writers, std::size_t readers);

/// Bytes of /dev/shm that the daemon needs with that configuration.
std::uintmax_t roudi_memory(std::size_t writers, std::size_t readers);

/// Free space of /dev/shm, in bytes. The kernel ends a process that writes beyond it (SIGBUS), so it is checked before memory is shared.
std::uintmax_t free_shared_memory();

}  // namespace quorient::bus
