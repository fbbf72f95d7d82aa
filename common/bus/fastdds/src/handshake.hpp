#pragma once

#include <atomic>
#include <chrono>
#include <cstddef>
#include <cstdint>

namespace quorient::bus::fastdds {

/// Whether a datagram carries a message of a handshake [DDS Security 7.4.3].
/// @param data  a datagram that `is_sound_rtps`
bool is_handshake(const std::uint8_t* data, std::size_t size);

/// Keeps what is received of handshakes from Fast DDS until 2 ms after it has sent the last message of one.
///
/// Why: while Fast DDS 2.9.1 sends such a message, to every participant in turn, it drops what it receives of the same handshake. Cyclone DDS
/// replies within 0.2 ms. The reply to each repetition, one a second, was then dropped as well, for good.
class HandshakePause {
public:
    static constexpr std::chrono::milliseconds length{2};

    void sent() { last_ = now(); }

    /// How long a received message has to wait still.
    std::chrono::nanoseconds left() const;

private:
    static std::int64_t now() { return std::chrono::steady_clock::now().time_since_epoch().count(); }

    std::atomic<std::int64_t> last_{0};
};

}  // namespace quorient::bus::fastdds
