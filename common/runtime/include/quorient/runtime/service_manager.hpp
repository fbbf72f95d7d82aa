#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string_view>

namespace quorient::runtime {

/// Talks to the service manager that started this process, if one did: the datagrams of sd_notify(3) to $NOTIFY_SOCKET.
/// The watchdog is fed only with handled frames: a process that lives and receives nothing is restarted.
/// Each of several services in one process has such an object. The process is ready once all are; the watchdog is fed once all have handled
/// a frame.
class ServiceManager {
public:
    /// From the environment. @returns nothing where no service manager listens.
    static std::optional<ServiceManager> from_environment();
    ~ServiceManager();
    ServiceManager(ServiceManager&& other) noexcept;
    ServiceManager& operator=(ServiceManager&& other) noexcept;

    /// Once, when the service sees all its inputs.
    void ready();

    void stopping();

    /// A frame was handled now [ns, steady]. Sends at most one datagram a second, more often only for a watchdog below 2 s; none
    /// without a watchdog.
    void frame_handled(std::int64_t steady_ns);

private:
    struct Service;

    ServiceManager(int socket, std::int64_t watchdog_ns);
    void send(std::string_view state) const;

    int socket_;
    std::int64_t watchdog_ns_;  // 0 = none
    std::shared_ptr<Service> service_;
};

}  // namespace quorient::runtime
