#pragma once

#include "quorient/bus/bus.hpp"
#include "quorient/messages/fault_command.hpp"
#include "quorient/messages/health_event.hpp"
#include "quorient/messages/identity.hpp"
#include "quorient/messages/meaning.hpp"
#include "quorient/messages/service_status.hpp"
#include "quorient/runtime/event_loop.hpp"
#include "quorient/runtime/heartbeat.hpp"
#include "quorient/runtime/service_manager.hpp"

#include <array>
#include <functional>
#include <initializer_list>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace quorient::runtime {

/// The orders that a process accepts.
struct OrderSettings {
    bool inject = true;  ///< inject and clear
    bool readmit = true;
    bool reset = true;
};

/// Who a process is.
struct NodeSettings {
    std::string name;
    std::uint32_t unit = 0;
    std::uint32_t service = 0;  ///< unique in the domain
    ServiceRole role = ServiceRole::unknown;
    bool stamps = false;     ///< fill the hop stamps of messages
    bool heartbeat = true;   ///< leave a heartbeat file, and notify the service manager
    bool log_events = true;  ///< also to stderr
    OrderSettings orders;
    std::int64_t identity_expires_ns = 0;  ///< when its certificate expires, since 1970; 0 = no certificate
};

/// What every service does beside its work: publishes its events and its status, leaves its heartbeat, watches its endpoints.
class Node {
public:
    Node(NodeSettings settings, bus::Bus& bus, EventLoop& loop);
    ~Node();
    Node(const Node&) = delete;
    Node& operator=(const Node&) = delete;

    /// One event: published, latched for late joiners, and logged.
    void report(EventCode code, Severity severity, Identity identity, std::uint32_t axes, std::string_view text, std::uint64_t request = 0);

    /// As report(), but at most once a second for each code. @returns whether it was reported now.
    bool report_throttled(EventCode code, Severity severity, Identity identity, std::uint32_t axes, std::string_view text);

    /// Publishes the new state at once.
    void set_state(ServiceState state);
    ServiceState state() const { return state_of(status_); }

    /// From `starting` to `ready` as soon as this is true. It is asked 50 times a second, and no more once the state is another one.
    void ready_when(std::function<bool()> has_all_it_needs);

    /// Counters are written here by the service and go out twice a second.
    ServiceStatus& status() { return status_; }

    /// Counts a handled frame: heartbeat, identity, and the time since its arrival.
    void handled(Identity identity, std::int64_t arrival_ns);

    /// Warns when this endpoint meets an incompatible peer, when it matched nobody within 5 s, and when it has not the transport asked for.
    void watch(std::string_view what, std::function<bus::EndpointStatus()> status, bool must_match);

    /// Calls the handler for orders of these kinds to this unit, once for each: a sender repeats its order until all services concerned
    /// have answered. An order that the settings do not permit is refused with an event that names the sender.
    void on_order(std::initializer_list<CommandAction> kinds, std::function<void(const FaultCommand&)> handler);

    /// The endpoint whose transport and peers the status states.
    void main_output(std::function<bus::EndpointStatus()> status) { main_output_ = std::move(status); }

    const NodeSettings& settings() const { return settings_; }
    const Clock& clock() const { return loop_.clock(); }
    EventLoop& loop() { return loop_; }
    bus::Bus& bus() { return bus_; }

    /// Now, if stamps are asked for; else 0.
    std::int64_t stamp() const { return settings_.stamps ? clock().steady_ns() : 0; }

private:
    struct Watched {
        std::string what;
        std::function<bus::EndpointStatus()> status;
        bool must_match;  ///< and has not yet
        std::uint32_t incompatible = 0;
        std::uint64_t refused = 0;
        bool reported_unmatched = false;
        bool reported_fallback = false;
    };

    bool is_new(std::uint64_t request);
    bool permits(CommandAction action) const;
    void refuse(const FaultCommand& order);
    void publish_status();
    void look_at_endpoints();
    void look_at_shared_memory();
    void look_at_identity();
    void look_at_refusals();

    NodeSettings settings_;
    bus::Bus& bus_;
    EventLoop& loop_;
    bus::Publisher<HealthEvent> events_;
    bus::Publisher<ServiceStatus> statuses_;
    std::optional<Heartbeat> heartbeat_;
    std::int64_t beat_ns_ = 0;
    std::optional<ServiceManager> service_manager_;
    ServiceStatus status_;
    std::uint64_t event_number_ = 0;
    std::array<std::int64_t, 256> last_reported_ns_{};
    std::array<std::int64_t, 1024> latency_ns_{};  // ring of the newest
    std::size_t latency_count_ = 0;
    std::array<std::uint64_t, 16> request_{};  // ring of the newest
    std::size_t request_count_ = 0;
    std::vector<Watched> watched_;
    std::function<bus::EndpointStatus()> main_output_;
    bool reported_shared_memory_lost_ = false;
    bus::Subscription<FaultCommand>* orders_ = nullptr;
    std::int64_t expiry_reported_ns_ = 0;  ///< steady; 0 = never
    std::int64_t started_ns_;
};

}  // namespace quorient::runtime
