#pragma once

#include "picture.hpp"
#include "tick.hpp"

#include <cstdint>
#include <map>
#include <prometheus/counter.h>
#include <prometheus/family.h>
#include <prometheus/gauge.h>
#include <prometheus/histogram.h>
#include <prometheus/registry.h>
#include <string>
#include <vector>

namespace quorient::monitor {

/// The figures that Prometheus collects, from ticks. One thread updates; any number of threads may read text().
/// Names and meanings: README.md.
class Metrics {
public:
    explicit Metrics(const Names& names);

    void update(const Tick& tick);

    /// In Prometheus's text format.
    std::string text() const;

    /// The web side's own state.
    struct Server {
        std::uint64_t streams = 0;
        std::uint64_t refused = 0;
        std::uint64_t viewers = 0;
        std::uint64_t dropped = 0;
    };
    void set_server(const Server& server);

private:
    using Labels = std::map<std::string, std::string>;
    using Gauges = prometheus::Family<prometheus::Gauge>;
    using Counters = prometheus::Family<prometheus::Counter>;

    Gauges& gauges(const char* name, const char* help);
    Counters& counters(const char* name, const char* help);

    /// Raises a counter to a total that a service reports; a total that fell comes from a service that has started again.
    void raise(Counters& family, const Labels& labels, std::uint64_t total);

    void update_output(const Tick& tick);
    void update_lanes(const Tick& tick);
    void update_services(const Tick& tick);
    void update_events(const Tick& tick);

    const Names& names_;
    prometheus::Registry registry_;
    Gauges& level_;
    Gauges& output_age_;
    Gauges& sigma_;
    Gauges& spread_;
    Gauges& error_;
    Counters& frames_;
    prometheus::Family<prometheus::Histogram>& latency_;
    Gauges& lane_standing_;
    Gauges& lane_state_;
    Gauges& axis_state_;
    Counters& isolations_;
    Gauges& service_up_;
    Counters& restarts_;
    Counters& service_frames_;
    Counters& service_troubles_;
    Gauges& service_latency_;
    Counters& events_;
    Gauges& streams_;
    Counters& refused_;
    Gauges& viewers_;
    Counters& dropped_;
    Counters& deferred_;
    std::map<std::string, std::uint64_t> totals_;
    std::vector<AxisMask> isolated_;  // by lane
};

}  // namespace quorient::monitor
