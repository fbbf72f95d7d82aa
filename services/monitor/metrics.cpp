#include "metrics.hpp"

#include "axis_state.hpp"
#include "quorient/messages/meaning.hpp"
#include "quorient/messages/name.hpp"
#include "quorient/messages/words.hpp"

#include <prometheus/text_serializer.h>
#include <algorithm>
#include <array>
#include <sstream>

namespace quorient::monitor {
namespace {

constexpr std::array levels{"FULL", "DEGRADED", "SINGLE", "COASTING", "LOST", "NO OUTPUT"};
constexpr std::array standings{"primary",   "vouches",        "in",       "silent",    "initialising", "disagrees",
                               "uncorroborated", "outvoted", "untrusted", "invalid"};
constexpr std::array verdict_states{VerdictState::warming_up, VerdictState::healthy, VerdictState::suspect,     VerdictState::isolated,
                                    VerdictState::ambiguous,  VerdictState::blind,   VerdictState::provisional, VerdictState::saturated};
constexpr std::array axis_states{AxisState::healthy,   AxisState::degraded, AxisState::suspect, AxisState::saturated,
                                 AxisState::absent,    AxisState::left_out, AxisState::isolated};

/// A service sends its status twice a second.
constexpr double longest_silence_s = 2;

/// One gauge per word, of which one is 1: Prometheus's way to show an enumeration.
template <class Words, class Name>
void set_state(prometheus::Family<prometheus::Gauge>& family, std::map<std::string, std::string> labels, const Words& words,
               std::string_view now, Name name)
{
    for (const auto& word : words) {
        labels["state"] = std::string{name(word)};
        family.Add(labels).Set(name(word) == now ? 1 : 0);
    }
}

std::string_view as_it_is(std::string_view word)
{
    return word;
}

}  // namespace

Metrics::Gauges& Metrics::gauges(const char* name, const char* help)
{
    return prometheus::BuildGauge().Name(name).Help(help).Labels({{"unit", std::to_string(names_.unit)}}).Register(registry_);
}

Metrics::Counters& Metrics::counters(const char* name, const char* help)
{
    return prometheus::BuildCounter().Name(name).Help(help).Labels({{"unit", std::to_string(names_.unit)}}).Register(registry_);
}

Metrics::Metrics(const Names& names)
    : names_(names),
      level_(gauges("quorient_level", "How many lanes stand behind the voted attitude: 1 for the state that holds")),
      output_age_(gauges("quorient_output_age_seconds", "Time since the newest voted attitude")),
      sigma_(gauges("quorient_attitude_sigma_radians", "Standard deviation of the voted attitude's angle error")),
      spread_(gauges("quorient_lane_spread_radians", "Largest angle among the lanes that vouch")),
      error_(gauges("quorient_attitude_error_radians", "Angle of the voted attitude to the truth, where there is one")),
      frames_(counters("quorient_voted_frames_total", "Voted attitudes received by the monitor")),
      latency_(prometheus::BuildHistogram()
                   .Name("quorient_sensor_to_voted_seconds")
                   .Help("From the sensor's output to the voter's, where the system file asks for stamps")
                   .Labels({{"unit", std::to_string(names_.unit)}})
                   .Register(registry_)),
      lane_standing_(gauges("quorient_lane_standing", "What the voter makes of a lane: 1 for the state that holds")),
      lane_state_(gauges("quorient_lane_verdict", "A lane's verdict on the cluster: 1 for the state that holds")),
      axis_state_(gauges("quorient_axis_state", "What the system makes of an axis: 1 for the state that holds")),
      isolations_(counters("quorient_isolations_total", "Isolations of an axis by a lane")),
      service_up_(gauges("quorient_service_up", "1 while the service's status arrives")),
      restarts_(counters("quorient_service_restarts_total", "Changes of the service's process")),
      service_frames_(counters("quorient_service_frames_total", "Samples that the service received and published")),
      service_troubles_(counters("quorient_service_troubles_total", "Samples missing, duplicate, late, foreign or rejected at the service")),
      service_latency_(gauges("quorient_service_latency_seconds", "From arrival to publication, over the last half second")),
      events_(counters("quorient_events_total", "Events of the system")),
      streams_(gauges("quorient_monitor_streams", "Pages that receive the event stream")),
      refused_(counters("quorient_monitor_connections_refused_total", "Connections closed because all threads were busy")),
      viewers_(gauges("quorient_monitor_viewers", "Viewers connected by WebSocket")),
      dropped_(counters("quorient_monitor_viewer_messages_dropped_total", "Messages that slow viewers did not take")),
      deferred_(counters("quorient_monitor_ticks_deferred_total", "Ticks that the web side took over late")),
      isolated_(names.lanes.size(), 0)
{
}

void Metrics::raise(Counters& family, const Labels& labels, std::uint64_t total)
{
    std::string key{family.GetName()};
    for (const auto& [name, value] : labels) key += '\n' + value;
    auto& known = totals_[key];
    family.Add(labels).Increment(static_cast<double>(total >= known ? total - known : total));
    known = total;
}

void Metrics::update(const Tick& tick)
{
    update_output(tick);
    update_lanes(tick);
    update_services(tick);
    update_events(tick);
    raise(deferred_, {}, tick.ticks_deferred);
}

void Metrics::update_output(const Tick& tick)
{
    if (!names_.has_attitude) return;
    set_state(level_, {}, levels, level_word(tick), as_it_is);
    output_age_.Add({}).Set(tick.voted_age_s);
    sigma_.Add({}).Set(tick.voted_fresh ? tick.voted.angle_sigma_rad : not_known);
    spread_.Add({}).Set(tick.voted_fresh ? tick.voted.spread_rad : not_known);
    error_.Add({}).Set(tick.error_rad);
    frames_.Add({}).Increment(static_cast<double>(tick.voted_frames));
    static const prometheus::Histogram::BucketBoundaries edges(latency_edges_s.begin(), latency_edges_s.end());
    const std::vector<double> counts(tick.latencies.count.begin(), tick.latencies.count.end());
    latency_.Add({}, edges).ObserveMultiple(counts, tick.latencies.sum_s);
}

void Metrics::update_lanes(const Tick& tick)
{
    const auto word = [](auto state) { return to_string(state); };
    const std::size_t axes = tick.described ? std::min<std::size_t>(tick.description.axis_count, max_axes) : 0;
    for (std::size_t place = 0; place < names_.lanes.size(); ++place) {
        const auto& lane = tick.lane[place];
        if (names_.has_attitude)
            set_state(lane_standing_, {{"lane", names_.lanes[place]}}, standings, standing(tick, names_, place), as_it_is);
        set_state(lane_state_, {{"lane", names_.lanes[place]}}, verdict_states, lane.fresh ? to_string(state_of(lane.verdict)) : "", word);
        for (std::size_t axis = 0; axis < axes; ++axis) {
            auto& counter = isolations_.Add({{"lane", names_.lanes[place]}, {"axis", axis_name(tick.description, axis)}});
            if (has_axis(lane.isolated & ~isolated_[place], axis)) counter.Increment();
        }
        isolated_[place] = lane.verdict.isolated_mask;
    }
    for (std::size_t axis = 0; axis < axes; ++axis)
        set_state(axis_state_, {{"axis", axis_name(tick.description, axis)}}, axis_states,
                  to_string(state_in_system(tick, names_.lanes.size(), axis)), word);
}

void Metrics::update_services(const Tick& tick)
{
    for (std::size_t place = 0; place < tick.services; ++place) {
        const auto& service = tick.service[place];
        const auto& status = service.status;
        const Labels labels{{"service", std::string{text_of(status.name)}}, {"role", std::string{to_string(role_of(status))}}};
        const auto with = [&labels](const char* name, const char* value) {
            auto more = labels;
            more[name] = value;
            return more;
        };
        const bool up = service.age_s < longest_silence_s && state_of(status) != ServiceState::stopping;
        service_up_.Add(labels).Set(up ? 1 : 0);
        raise(restarts_, labels, service.restarts);
        raise(service_frames_, with("direction", "received"), status.received);
        raise(service_frames_, with("direction", "published"), status.published);
        raise(service_troubles_, with("kind", "gap"), status.gaps);
        raise(service_troubles_, with("kind", "duplicate"), status.duplicates);
        raise(service_troubles_, with("kind", "late"), status.late);
        raise(service_troubles_, with("kind", "foreign"), status.foreign);
        raise(service_troubles_, with("kind", "rejected"), status.rejected);
        service_latency_.Add(with("percentile", "50")).Set(status.latency_s[0]);
        service_latency_.Add(with("percentile", "90")).Set(status.latency_s[1]);
        service_latency_.Add(with("percentile", "99")).Set(status.latency_s[2]);
    }
}

void Metrics::update_events(const Tick& tick)
{
    for (const auto& event : tick.events)
        events_.Add({{"code", std::string{to_string(code_of(event))}}, {"severity", std::string{to_string(severity_of(event))}}}).Increment();
}

void Metrics::set_server(const Server& server)
{
    streams_.Add({}).Set(static_cast<double>(server.streams));
    raise(refused_, {}, server.refused);
    viewers_.Add({}).Set(static_cast<double>(server.viewers));
    raise(dropped_, {}, server.dropped);
}

std::string Metrics::text() const
{
    std::ostringstream text;
    prometheus::TextSerializer{}.Serialize(text, registry_.Collect());
    return text.str();
}

}  // namespace quorient::monitor
