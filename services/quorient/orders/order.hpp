#pragma once

#include "quorient/bus/bus.hpp"
#include "quorient/messages/fault_command.hpp"
#include "quorient/messages/health_event.hpp"
#include "quorient/messages/service_status.hpp"
#include "quorient/runtime/event_loop.hpp"

#include <cstdint>
#include <map>
#include <optional>
#include <set>
#include <string>

namespace quorient::cli {

/// One order to a unit's services. It is repeated until each service that it concerns has answered: a service that has just started, or
/// that this process has just found, may not receive the first one. Which services it concerns is known from the services' status.
class Order {
public:
    static constexpr double patience_s = 5;

    /// Answers go to stdout. Ends `loop` with 0 if all have done it, 1 if one refused or did not answer in time (named on stderr).
    /// @param secured  the system runs under DDS Security: services are found later.
    Order(const FaultCommand& command, bus::Bus& bus, runtime::EventLoop& loop, bool secured = false);

private:
    void look();
    void give(std::int64_t now_ns);
    void on_status(const ServiceStatus& status);
    void on_event(const HealthEvent& event);
    void give_up();
    bool is_ready(std::int64_t now_ns);
    std::string unanswered() const;  ///< names, empty if there are none

    FaultCommand command_;
    runtime::EventLoop& loop_;
    bus::Publisher<FaultCommand> commands_;
    bool of_a_frame_;         ///< the order is about the newest frame
    std::int64_t search_ns_;  ///< from the first word on, for services that it concerns
    std::int64_t begin_ns_;
    std::optional<std::int64_t> first_given_ns_;
    std::int64_t given_ns_ = 0;
    std::optional<std::uint64_t> newest_;             ///< frame
    std::map<std::uint32_t, std::string> concerned_;  ///< names by service id
    std::set<std::uint32_t> answered_;
    bool refused_ = false;
};

}  // namespace quorient::cli
