#pragma once

#include "quorient/messages/identity.hpp"
#include "quorient/messages/truth_state.hpp"
#include "quorient/system/system.hpp"
#include "tick.hpp"

#include <array>
#include <cstdint>

namespace quorient::monitor {

/// From the messages of one unit to ticks. Knows no clock, thread or DDS, and allocates nothing after its construction.
class Collector {
public:
    explicit Collector(const system::System& system);

    void on_description(const ClusterDescription& description);
    void on_truth(const TruthState& truth);
    void on_verdict(const FaultVerdict& verdict, std::int64_t now_ns);
    void on_diagnosis(const FaultDiagnosis& diagnosis);
    void on_voted(const VotedAttitude& voted, std::int64_t now_ns);
    void on_event(const HealthEvent& event);
    void on_status(const ServiceStatus& status, std::int64_t now_ns);

    /// The tick as it stands now. It keeps collecting until begin().
    const Tick& tick(std::int64_t now_ns, std::int64_t wall_time_ns);

    /// The tick was handed over: the next one begins.
    void begin();

    /// The tick was not taken; it goes on.
    void defer() { ++tick_.ticks_deferred; }

private:
    /// An attitude or a truth whose counterpart has not arrived yet.
    struct Half {
        Identity identity;
        std::array<double, 4> attitude{};
        bool waits = false;
    };
    using Halves = std::array<Half, 256>;  // by sequence

    void compare(const Half& half, Halves& counterparts, Halves& own);
    void look_at_latency(const VotedAttitude& voted);

    std::uint32_t unit_;
    std::array<std::uint32_t, max_lanes> detector_{};  // at the place of each lane
    std::size_t lanes_;
    Tick tick_;
    std::array<std::int64_t, max_lanes> verdict_ns_{};
    std::array<std::int64_t, max_services> status_ns_{};
    std::int64_t voted_ns_ = 0;
    Halves truths_{};
    Halves outputs_{};
};

}  // namespace quorient::monitor
