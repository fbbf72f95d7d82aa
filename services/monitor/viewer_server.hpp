#pragma once

#include "picture.hpp"
#include "tick.hpp"

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <string_view>

namespace quorient::monitor {

/// What viewers may take from this process.
struct ViewerLimits {
    std::size_t viewers = 32;                         ///< open at once; the next one is closed
    std::size_t request_bytes = 64 * 1024;            ///< in one message from a viewer
    std::size_t waiting = 64;                         ///< messages that one viewer has not taken; what comes on top is dropped and counted
    std::chrono::milliseconds silence{15'000};        ///< a viewer that answers no ping for so long is closed
};

/// Foxglove's live protocol: WebSocket, subprotocols `foxglove.websocket.v1` and `foxglove.sdk.v1` (the same under another name).
/// Foxglove and Lichtblick connect to it. Viewers receive, and nothing that they send reaches the system.
///
/// One thread serves all of them. A viewer that is slow loses messages, one that sends garbage is closed, and others notice neither.
class ViewerServer {
public:
    explicit ViewerServer(const Names& names, const ViewerLimits& limits = {});
    ~ViewerServer();
    ViewerServer(const ViewerServer&) = delete;
    ViewerServer& operator=(const ViewerServer&) = delete;

    /// The subprotocol to answer with, of those in a request's Sec-WebSocket-Protocol; nothing where none is known.
    static std::optional<std::string> chosen_protocol(std::string_view offered);

    /// Whether a request with this Origin may connect: programs, this host's own pages, and Foxglove's web application.
    static bool may_connect(std::string_view origin, std::string_view own_address);

    /// Takes over a connected TCP socket whose request for an upgrade has been read already. Any thread.
    void take_over(int socket, std::string request, std::string protocol);

    /// Sends this tick to those who subscribed. Waits for nobody. Any thread.
    void publish(const Tick& tick);

    std::size_t viewers() const;
    std::uint64_t dropped() const;

private:
    struct Implementation;
    std::unique_ptr<Implementation> its_;
};

}  // namespace quorient::monitor
