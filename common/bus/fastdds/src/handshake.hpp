#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>

namespace quorient::bus::fastdds {

/// How long a message of the handshake waits before Fast DDS receives it.
///
/// Why: while Fast DDS 2.9.1 sends a message of a handshake, to every participant in turn, it drops what it receives of the same handshake. Cyclone
/// DDS replies within 0.2 ms. The reply to each repetition, one a second, was then dropped as well, for good.
constexpr std::chrono::milliseconds handshake_delay{2};

/// Whether a datagram carries a message of a handshake [DDS Security 7.4.3].
/// @param data  a datagram that `is_sound_rtps`
bool is_handshake(const std::uint8_t* data, std::size_t size);

}  // namespace quorient::bus::fastdds
