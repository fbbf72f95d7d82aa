#include "web_server.hpp"

#include <arpa/inet.h>
#include <fmt/format.h>
#include <netinet/in.h>
#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>
#include <algorithm>
#include <array>
#include <cerrno>
#include <cstring>
#include <deque>
#include <optional>
#include <stdexcept>
#include <thread>
#include <utility>
#include <vector>

namespace quorient::monitor {
namespace {

using Clock = std::chrono::steady_clock;

/// The accepting thread is turning a connection away.
thread_local bool refusing = false;

/// What the connection that this thread serves goes on with.
thread_local std::optional<std::string> next_protocol;

/// One connection as httplib reads and writes it, within the limits.
class Connection final : public httplib::Stream {
public:
    Connection(socket_t socket, const Limits& limits, const std::atomic<bool>& ending)
        : socket_(socket), limits_(limits), ending_(ending), request_ends_(Clock::now() + limits.request_patience)
    {
    }

    bool is_readable() const override { return begin_ < end_ || wait(POLLIN, Clock::now()); }
    bool is_writable() const override { return wait(POLLOUT, Clock::now() + limits_.write_patience); }

    ssize_t read(char* bytes, size_t size) override
    {
        if (begin_ == end_ && !fill()) return -1;
        const auto count = std::min(size, end_ - begin_);
        std::copy_n(buffer_.begin() + static_cast<std::ptrdiff_t>(begin_), count, bytes);
        begin_ += count;
        return static_cast<ssize_t>(count);
    }

    ssize_t write(const char* bytes, size_t size) override
    {
        if (next_protocol) return static_cast<ssize_t>(size);
        size_t sent = 0;
        while (sent < size) {
            if (!is_writable()) return -1;
            const auto count = ::send(socket_, bytes + sent, size - sent, MSG_NOSIGNAL | MSG_DONTWAIT);
            if (count > 0) sent += static_cast<size_t>(count);
            else if (count == 0 || (errno != EAGAIN && errno != EINTR)) return -1;
        }
        return static_cast<ssize_t>(sent);
    }

    void get_remote_ip_and_port(std::string& ip, int& port) const override { name(::getpeername, ip, port); }
    void get_local_ip_and_port(std::string& ip, int& port) const override { name(::getsockname, ip, port); }
    socket_t socket() const override { return socket_; }

    /// All that has been read so far.
    const std::string& request() const { return request_; }

private:
    bool fill()
    {
        if (request_.size() >= limits_.request_bytes || !wait(POLLIN, request_ends_)) return false;
        const auto count = ::recv(socket_, buffer_.data(), buffer_.size(), 0);
        if (count <= 0) return false;
        request_.append(buffer_.data(), static_cast<size_t>(count));
        begin_ = 0;
        end_ = static_cast<size_t>(count);
        return true;
    }

    bool wait(short what, Clock::time_point deadline) const
    {
        constexpr std::chrono::milliseconds slice{100};
        do {
            const auto left = std::chrono::duration_cast<std::chrono::milliseconds>(deadline - Clock::now());
            pollfd entry{socket_, what, 0};
            const int ready = ::poll(&entry, 1, static_cast<int>(std::clamp(left, std::chrono::milliseconds{0}, slice).count()));
            if (ready > 0) return (entry.revents & what) != 0;
            if (ready < 0 && errno != EINTR) return false;
        } while (!ending_ && Clock::now() < deadline);
        return false;
    }

    template <class Ask>
    void name(Ask ask, std::string& ip, int& port) const
    {
        sockaddr_in address{};
        socklen_t size = sizeof address;
        if (ask(socket_, reinterpret_cast<sockaddr*>(&address), &size) != 0) return;
        std::array<char, INET_ADDRSTRLEN> text{};
        ip = ::inet_ntop(AF_INET, &address.sin_addr, text.data(), text.size());
        port = ntohs(address.sin_port);
    }

    socket_t socket_;
    const Limits& limits_;
    const std::atomic<bool>& ending_;
    Clock::time_point request_ends_;
    std::array<char, 4096> buffer_{};
    size_t begin_ = 0;
    size_t end_ = 0;
    std::string request_;
};

/// What httplib's queue returns for an entry: nothing, or since release 0.14 whether it was taken.
using Enqueued = decltype(std::declval<httplib::TaskQueue&>().enqueue({}));

/// A thread per connection, and never more connections than threads: what comes on top is turned away by the accepting thread.
class BoundedThreads final : public httplib::TaskQueue {
public:
    BoundedThreads(std::size_t count, std::atomic<std::uint64_t>& refused) : refused_(refused)
    {
        for (std::size_t i = 0; i < count; ++i) threads_.emplace_back([this] { work(); });
    }

    Enqueued enqueue(std::function<void()> connection) override
    {
        {
            const std::lock_guard lock{mutex_};
            if (open_ < threads_.size()) {
                ++open_;
                waiting_.push_back(std::move(connection));
                arrived_.notify_one();
                return Enqueued(true);
            }
        }
        ++refused_;
        refusing = true;
        connection();
        refusing = false;
        return Enqueued(true);  // the socket is closed already
    }

    void shutdown() override
    {
        {
            const std::lock_guard lock{mutex_};
            ended_ = true;
        }
        arrived_.notify_all();
        for (auto& thread : threads_) thread.join();
    }

private:
    void work()
    {
        std::unique_lock lock{mutex_};
        for (;;) {
            arrived_.wait(lock, [this] { return ended_ || !waiting_.empty(); });
            if (waiting_.empty()) return;
            const auto connection = std::move(waiting_.front());
            waiting_.pop_front();
            lock.unlock();
            connection();
            lock.lock();
            --open_;
        }
    }

    std::atomic<std::uint64_t>& refused_;
    std::mutex mutex_;
    std::condition_variable arrived_;
    std::deque<std::function<void()>> waiting_;
    std::size_t open_ = 0;  // connections that wait or are served
    bool ended_ = false;
    std::vector<std::thread> threads_;
};

}  // namespace

WebServer::WebServer(const Limits& limits) : limits_(limits)
{
    new_task_queue = [this] { return new BoundedThreads(limits_.threads, refused_); };
    // httplib's own choice, SO_REUSEPORT, would let a second monitor share the port unnoticed.
    set_socket_options([](socket_t socket) {
        const int on = 1;
        ::setsockopt(socket, SOL_SOCKET, SO_REUSEADDR, &on, sizeof on);
    });
    set_payload_max_length(limits_.request_bytes);
}

int WebServer::open(const std::string& address, int port)
{
    errno = 0;
    const int bound = port == 0 ? bind_to_any_port(address) : bind_to_port(address, port) ? port : -1;
    if (bound < 0)
        throw std::runtime_error(fmt::format("cannot serve http://{}:{}: {}; state another monitor.address or monitor.port", address, port,
                                             errno != 0 ? std::strerror(errno) : "refused"));
    ::listen(svr_sock_, SOMAXCONN);  // httplib's backlog of 5 makes a burst of clients wait a second
    return bound;
}

void WebServer::go_on_with(std::string protocol)
{
    next_protocol = std::move(protocol);
}

template <class Stream>
bool WebServer::answer(Stream& connection)
{
    bool closed = false;
    if constexpr (requires { this->process_request(connection, true, closed, nullptr); }) {
        return process_request(connection, true, closed, nullptr);
    } else {  // later releases of httplib do not ask the stream for its addresses
        std::string remote, local;
        int remote_port = 0, local_port = 0;
        connection.get_remote_ip_and_port(remote, remote_port);
        connection.get_local_ip_and_port(local, local_port);
        return process_request(connection, remote, remote_port, local, local_port, true, closed, nullptr);
    }
}

bool WebServer::process_and_close_socket(socket_t socket)
{
    bool handled = false;
    if (!refusing) {
        ::setsockopt(socket, SOL_SOCKET, SO_SNDBUF, &limits_.send_buffer_bytes, sizeof limits_.send_buffer_bytes);
        Connection connection{socket, limits_, ending_};
        next_protocol.reset();
        handled = answer(connection);
        if (next_protocol) {
            next_protocol_(socket, connection.request(), *std::exchange(next_protocol, std::nullopt));
            return handled;
        }
        ::shutdown(socket, SHUT_RDWR);
    }
    ::close(socket);
    return handled;
}

}  // namespace quorient::monitor
