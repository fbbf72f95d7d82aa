#pragma once

#include <atomic>
#include <chrono>
#include <cstddef>
#include <cstdint>
#include <mutex>

namespace quorient::bus::fastdds {

/// Whether a datagram carries a message of a handshake [DDS Security 7.4.3].
/// @param data  a datagram, or its beginning up to a submessage's payload: release 3 of Fast DDS sends the payload from another buffer
bool is_handshake(const std::uint8_t* data, std::size_t size);

/// Keeps what is received of handshakes from Fast DDS until 2 ms after it has sent the last message of one.
///
/// Why: while Fast DDS 2.9.1 sends such a message, to every participant in turn, it drops what it receives of the same handshake. Cyclone DDS
/// replies within 0.2 ms. The reply to each repetition, one a second, was then dropped as well, for good.
class HandshakePause {
public:
    static constexpr std::chrono::milliseconds length{2};
    static constexpr std::chrono::milliseconds longest{10};

    void sent() { last_ = now(); }

    /// How long a received message has to wait still.
    std::chrono::nanoseconds left() const;

    /// Locks when nothing is left, also of messages that are sent while this waits; after `longest` in any case. Waits without the lock.
    void lock_after(std::unique_lock<std::mutex>& lock) const;

private:
    static std::int64_t now() { return std::chrono::steady_clock::now().time_since_epoch().count(); }

    std::atomic<std::int64_t> last_{0};
};

}  // namespace quorient::bus::fastdds
