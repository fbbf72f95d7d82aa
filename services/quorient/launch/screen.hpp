#pragma once

#include "event_order.hpp"
#include "processes.hpp"
#include "quorient/evaluation/run_observer.hpp"
#include "quorient/messages/health_event.hpp"
#include "story.hpp"

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace quorient::launch {

/// What a user sees of a running system. On a terminal: one line that answers whether the attitude is good, what differs from normal, and
/// what happened; drawn anew. Elsewhere: one line per event, in the order of time.
class Screen {
public:
    Screen(const system::System& system, const evaluation::RunObserver& run, bool quiet);

    void on_event(const HealthEvent& event, std::int64_t steady_ns);

    /// Prints the events that no earlier one can precede any more (not on a terminal).
    void print_due(std::int64_t steady_ns);

    /// At the end of the run: those that are left.
    void print_rest();

    /// Draws it (on a terminal). @param now_ns  wall time
    void draw(const Processes& processes, std::int64_t now_ns);

private:
    static void print(const std::vector<EventOrder::Held>& events);
    std::string time_of(const HealthEvent& event) const;
    std::string standing(std::int64_t now_ns) const;
    std::vector<std::string> lines(const Processes& processes, std::int64_t now_ns) const;

    const system::System& system_;
    const evaluation::RunObserver& run_;
    bool quiet_;
    bool terminal_;
    std::size_t drawn_lines_ = 0;
    Story story_;
    EventOrder order_;
    std::optional<std::int64_t> level_since_ns_;
    std::uint32_t level_voter_ = 0;  ///< service whose level that is
};

/// What differs from normal among lanes and processes, a line each, and one line for all that is normal.
std::vector<std::string> lane_lines(const system::System& system, const evaluation::RunObserver& run);
std::vector<std::string> process_lines(const Processes& processes);

}  // namespace quorient::launch
