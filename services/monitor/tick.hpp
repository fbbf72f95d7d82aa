#pragma once

#include "quorient/messages/cluster_description.hpp"
#include "quorient/messages/fault_diagnosis.hpp"
#include "quorient/messages/fault_verdict.hpp"
#include "quorient/messages/health_event.hpp"
#include "quorient/messages/service_status.hpp"
#include "quorient/messages/voted_attitude.hpp"

#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <vector>

namespace quorient::monitor {

/// Most services of one unit that are shown.
inline constexpr std::size_t max_services = 32;

/// Most events of one tick: every source's latched history at once.
inline constexpr std::size_t max_events = 2560;

inline constexpr double not_known = std::numeric_limits<double>::quiet_NaN();

/// The smallest and the largest value of a time, so that a spike of one sample stays visible.
struct Range {
    double lowest = std::numeric_limits<double>::infinity();
    double highest = -std::numeric_limits<double>::infinity();

    bool empty() const { return !(lowest <= highest); }

    /// A value that is not a number is left out.
    void add(double value)
    {
        if (value < lowest) lowest = value;
        if (value > highest) highest = value;
    }
    void add(const Range& other)
    {
        if (other.empty()) return;
        add(other.lowest);
        add(other.highest);
    }
};

/// What one detector reported during a tick.
struct LaneTick {
    FaultVerdict verdict;  ///< the newest
    FaultDiagnosis diagnosis;
    bool fresh = false;            ///< the verdict is younger than a second
    std::uint64_t verdicts = 0;    ///< in this tick
    AxisMask isolated = 0;         ///< at any moment of this tick; likewise below
    AxisMask provisional = 0;
    AxisMask suspect = 0;
    std::array<Range, max_axes> residual{};  ///< [rad; m/s]
};

/// How one service is doing.
struct ServiceTick {
    ServiceStatus status;
    double age_s = 0;                ///< the status's
    double rate_hz = not_known;        ///< at which it publishes, from the last two statuses
    std::uint32_t restarts = 0;      ///< seen by this monitor
};

/// Upper edges of the latency histogram [s]; one bucket more for what is slower.
inline constexpr std::array<double, 10> latency_edges_s{1e-4, 2e-4, 5e-4, 1e-3, 2e-3, 5e-3, 1e-2, 2e-2, 5e-2, 0.1};

/// How long frames took from the sensor to the voter's output; empty where the system file does not ask for stamps.
struct Latencies {
    std::array<std::uint32_t, latency_edges_s.size() + 1> count{};
    double sum_s = 0;

    void add(double latency_s)
    {
        std::size_t bucket = 0;
        while (bucket < latency_edges_s.size() && latency_s > latency_edges_s[bucket]) ++bucket;
        ++count[bucket];
        sum_s += latency_s;
    }
};

/// All that the monitor knows at one moment, and what happened since the tick before. A plain value: the DDS thread hands it over whole.
struct Tick {
    std::uint64_t number = 0;
    std::int64_t wall_time_ns = 0;
    ClusterDescription description;
    VotedAttitude voted;
    bool described = false;       ///< a description has arrived
    bool voted_fresh = false;     ///< the voted attitude is younger than a second
    double voted_age_s = not_known;
    std::uint64_t voted_frames = 0;    ///< in this tick
    double error_rad = not_known;        ///< the newest voted attitude against the truth
    Range error;                       ///< likewise, over this tick
    std::array<LaneTick, max_lanes> lane{};
    std::array<ServiceTick, max_services> service{};
    std::size_t services = 0;
    Latencies latencies;
    std::vector<HealthEvent> events;   ///< new ones, in order of arrival
    std::uint64_t events_lost = 0;     ///< since the start: more at once than max_events
    std::uint64_t ticks_deferred = 0;  ///< since the start: the web side had not taken the tick before
};

}  // namespace quorient::monitor
