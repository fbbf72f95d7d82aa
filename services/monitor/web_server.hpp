#pragma once

#include <httplib.h>

#include <atomic>
#include <chrono>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <string>
#include <utility>

namespace quorient::monitor {

/// What clients may take from this process.
struct Limits {
    std::size_t threads = 128;                         ///< one per open connection; a connection more is closed at once
    std::size_t streams = 100;                         ///< connections that stay open, among them
    std::size_t request_bytes = 64 * 1024;             ///< in one request
    std::chrono::milliseconds request_patience{3000};  ///< for a whole request to arrive
    std::chrono::milliseconds write_patience{5000};    ///< for a client that does not read
    int send_buffer_bytes = 256 * 1024;
};

/// cpp-httplib's server with bounds: on connections, on the bytes and the time of a request, and on the patience with a client that does not read.
class WebServer final : public httplib::Server {
public:
    explicit WebServer(const Limits& limits);

    /// Binds the address. @returns the port; throws std::runtime_error with the reason where it is refused.
    int open(const std::string& address, int port);

    /// Ends the streams within a tenth of a second; stop() follows.
    void end_streams() { ending_ = true; }

    std::uint64_t refused() const { return refused_; }

    /// Takes over the socket of a connection that goes on with another protocol, with the bytes of its request.
    using NextProtocol = std::function<void(int socket, std::string request, std::string protocol)>;
    void set_next_protocol(NextProtocol next) { next_protocol_ = std::move(next); }

    /// Called by a handler: no response is sent to this request, and its connection goes on with that protocol.
    static void go_on_with(std::string protocol);

private:
    bool process_and_close_socket(socket_t socket) override;

    /// Receives one request and sends the response, by the interface of httplib's release.
    template <class Stream>
    bool answer(Stream& connection);

    Limits limits_;
    std::atomic<std::uint64_t> refused_{0};
    std::atomic<bool> ending_{false};
    NextProtocol next_protocol_;
};

}  // namespace quorient::monitor
