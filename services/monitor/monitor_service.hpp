#pragma once

#include "collector.hpp"
#include "exchange.hpp"
#include "quorient/runtime/event_loop.hpp"
#include "quorient/runtime/heartbeat.hpp"
#include "quorient/runtime/service_manager.hpp"

#include <optional>

namespace quorient::monitor {

/// The DDS side: reads every topic that the page shows, and hands a tick to the web side ten times a second.
/// It writes nothing on DDS, unless the system file allows orders. Promises: README.md.
class MonitorService {
public:
    MonitorService(const system::System& system, Exchange& exchange, bus::Bus& bus, runtime::EventLoop& loop);

private:
    void subscribe(bus::Bus& bus, runtime::EventLoop& loop);
    void hand_over();
    void pass_orders();
    void on_event(const HealthEvent& event);

    /// An order under way: repeated until a service has answered, or its time is over.
    struct Underway {
        FaultCommand command;
        int repetitions = 0;
    };

    Exchange& exchange_;
    runtime::EventLoop& loop_;
    Collector collector_;
    std::uint32_t unit_;
    std::uint64_t newest_frame_ = 0;
    std::optional<runtime::Heartbeat> heartbeat_;
    std::optional<runtime::ServiceManager> service_manager_;
    std::optional<bus::Publisher<FaultCommand>> commands_;  // where orders are allowed
    std::optional<Underway> underway_;
};

}  // namespace quorient::monitor
