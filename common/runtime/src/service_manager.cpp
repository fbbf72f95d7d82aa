#include "quorient/runtime/service_manager.hpp"

#include <sys/socket.h>
#include <sys/un.h>
#include <unistd.h>
#include <algorithm>
#include <charconv>
#include <cstddef>
#include <cstdlib>
#include <cstring>
#include <utility>
#include <vector>

namespace quorient::runtime {

namespace {

constexpr std::int64_t longest_feeding_ns = 1'000'000'000;

std::int64_t whole_number(const char* variable)
{
    const char* text = std::getenv(variable);
    std::int64_t value = 0;
    if (text) std::from_chars(text, text + std::strlen(text), value);
    return value;
}

/// $WATCHDOG_USEC counts for the process that $WATCHDOG_PID names [sd_watchdog_enabled(3)].
std::int64_t watchdog_ns()
{
    const auto process = whole_number("WATCHDOG_PID");
    return process == 0 || process == ::getpid() ? whole_number("WATCHDOG_USEC") * 1000 : 0;
}

}  // namespace

/// One service, as far as the manager is concerned.
struct ServiceManager::Service {
    bool ready = false;
    bool handled = false;  ///< a frame, since the watchdog was fed last

    struct Process;
};

/// All services of this process, and its watchdog. There is one per process, since the service manager counts processes: READY=1 and
/// WATCHDOG=1 stand for all services of the process that sends them, and $NOTIFY_SOCKET is the process's as well. One thread, so no lock.
struct ServiceManager::Service::Process {
    std::vector<std::weak_ptr<Service>> services;
    std::int64_t fed_ns = 0;

    static Process& of_this()
    {
        static Process process;
        return process;
    }

    /// Whether it holds for each service that is there.
    bool each(bool Service::*state) const
    {
        return std::ranges::all_of(services, [state](const auto& known) {
            const auto service = known.lock();
            return !service || (*service).*state;
        });
    }

    void forget_handled()
    {
        for (const auto& known : services)
            if (const auto service = known.lock()) service->handled = false;
    }
};

std::optional<ServiceManager> ServiceManager::from_environment()
{
    const char* path = std::getenv("NOTIFY_SOCKET");
    sockaddr_un address{};
    address.sun_family = AF_UNIX;
    if (!path || (path[0] != '/' && path[0] != '@') || std::strlen(path) >= sizeof address.sun_path) return std::nullopt;
    std::memcpy(address.sun_path, path, std::strlen(path));
    if (path[0] == '@') address.sun_path[0] = '\0';  // Linux's abstract name space
    const int socket = ::socket(AF_UNIX, SOCK_DGRAM | SOCK_CLOEXEC, 0);
    if (socket < 0) return std::nullopt;
    const auto length = static_cast<socklen_t>(offsetof(sockaddr_un, sun_path) + std::strlen(path));
    ServiceManager manager{socket, watchdog_ns()};
    if (::connect(socket, reinterpret_cast<const sockaddr*>(&address), length) != 0) return std::nullopt;
    return manager;
}

ServiceManager::ServiceManager(int socket, std::int64_t watchdog_ns)
    : socket_(socket), watchdog_ns_(watchdog_ns), service_(std::make_shared<Service>())
{
    Service::Process::of_this().services.push_back(service_);
}

ServiceManager::~ServiceManager()
{
    if (socket_ >= 0) ::close(socket_);
}

ServiceManager::ServiceManager(ServiceManager&& other) noexcept
    : socket_(std::exchange(other.socket_, -1)), watchdog_ns_(other.watchdog_ns_), service_(std::move(other.service_))
{
}

ServiceManager& ServiceManager::operator=(ServiceManager&& other) noexcept
{
    std::swap(socket_, other.socket_);
    watchdog_ns_ = other.watchdog_ns_;
    service_ = std::move(other.service_);
    return *this;
}

void ServiceManager::ready()
{
    if (std::exchange(service_->ready, true)) return;
    if (Service::Process::of_this().each(&Service::ready)) send("READY=1");
}

void ServiceManager::stopping()
{
    send("STOPPING=1");
}

void ServiceManager::frame_handled(std::int64_t steady_ns)
{
    service_->handled = true;
    auto& process = Service::Process::of_this();
    if (watchdog_ns_ <= 0 || steady_ns - process.fed_ns < std::min(watchdog_ns_ / 2, longest_feeding_ns)) return;
    if (!process.each(&Service::handled)) return;
    process.forget_handled();
    process.fed_ns = steady_ns;
    send("WATCHDOG=1");
}

void ServiceManager::send(std::string_view state) const
{
    // A manager that does not read must not stop a service.
    static_cast<void>(::send(socket_, state.data(), state.size(), MSG_DONTWAIT | MSG_NOSIGNAL));
}

}  // namespace quorient::runtime
