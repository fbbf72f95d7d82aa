#pragma once

#include "quorient/messages/codes.hpp"
#include "quorient/messages/health_event.hpp"

#include <cstdint>
#include <deque>
#include <string>
#include <vector>

namespace quorient::launch {

/// The events of a run as a person reads them: in order of time, what is normal left out, and what several processes report of the same
/// thing at the same time as one line.
class Story {
public:
    explicit Story(std::size_t most_lines) : most_lines_(most_lines) {}

    /// @param time  of the run, as it shall be shown; may be empty
    void add(const HealthEvent& event, const std::string& time);

    /// " 8.010 s  detectors a, b, c     ISOLATED G2 since frame 1600 …", the newest last. "(x4)" where one line stands for more events
    /// than processes.
    std::vector<std::string> lines() const;

private:
    struct Entry {
        EventCode code;
        std::uint32_t axes;
        std::int64_t first_ns;  ///< wall time
        std::int64_t last_ns;
        std::string time;
        std::vector<std::string> sources;
        int events;
        std::string text;  ///< the newest
    };

    std::size_t most_lines_;
    std::deque<Entry> entries_;
};

/// "detectors a, b", "integrator c", "voter-1, voter-2".
std::string names_together(const std::vector<std::string>& processes);

}  // namespace quorient::launch
