#pragma once

#include "quorient/messages/health_event.hpp"

#include <cstdint>
#include <deque>
#include <string>
#include <vector>

namespace quorient::launch {

/// Puts events into the order of time. Each process's events arrive in order, those of several processes not: so each is held back for a
/// while, in which an earlier one may still arrive. One that arrives later than that comes out late.
class EventOrder {
public:
    struct Held {
        HealthEvent event;
        std::string time;  ///< in the run, as it shall be shown
        std::int64_t arrived_ns = 0;
    };

    static constexpr std::int64_t hold_back_ns = 200'000'000;

    /// @param now_ns  steady
    void add(const HealthEvent& event, std::string time, std::int64_t now_ns);

    /// The events that have been held back long enough, with all that happened before them: the earliest first.
    std::vector<Held> due(std::int64_t now_ns);

    /// All others: nothing more will come.
    std::vector<Held> rest();

private:
    std::vector<Held> first(std::size_t count);

    std::deque<Held> held_;  ///< in the order of their wall times
};

}  // namespace quorient::launch
