#pragma once

#include "quorient/evaluation/run_observer.hpp"
#include "processes.hpp"
#include "quorient/messages/health_event.hpp"

#include <deque>
#include <string>

namespace quorient::launch {

/// What a user sees of a running system: on a terminal a table that is drawn anew, elsewhere one line per event.
class Screen {
public:
    Screen(const system::System& system, const evaluation::RunObserver& run, bool quiet);

    void on_event(const HealthEvent& event);

    /// Draws the table (on a terminal).
    void draw(const Processes& processes);

private:
    std::string line_of(const HealthEvent& event) const;

    const system::System& system_;
    const evaluation::RunObserver& run_;
    bool quiet_;
    bool terminal_;
    int drawn_lines_ = 0;
    std::deque<std::string> latest_;
};

}  // namespace quorient::launch
