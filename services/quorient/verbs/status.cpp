#include "cli/message_json.hpp"
#include "quorient/bus/settings.hpp"
#include "quorient/bus/topics.hpp"
#include "quorient/messages/meaning.hpp"
#include "quorient/messages/name.hpp"
#include "quorient/messages/time.hpp"
#include "quorient/runtime/event_loop.hpp"
#include "quorient/runtime/signals.hpp"
#include "quorient/messages/words.hpp"
#include "cli/system_options.hpp"
#include "quorient/system/numbers.hpp"
#include "report/standing.hpp"
#include "report/starvation.hpp"
#include "verbs.hpp"

#include <fmt/chrono.h>
#include <fmt/format.h>
#include <unistd.h>
#include <algorithm>
#include <map>
#include <memory>
#include <utility>
#include <vector>

namespace quorient::cli {

namespace {

// A reader of `voted` matches writers whose lease is at most its own.
constexpr double longest_lease_s = 3600;

struct StatusOptions {
    BusOptions bus;
    double seconds = 2;
    std::size_t events = 20;
    bool watch = false;
    bool json = false;
};

/// Status comes twice a second: two samples of a service give its rate.
struct ReceivedService : report::Interval {
    std::int64_t first_received_ns = 0;  ///< steady
    std::int64_t received_ns = 0;
    bool begins_next = false;  ///< with the next status a new interval begins; until then the last one stands
};

using Services = std::map<std::uint32_t, ReceivedService>;

/// One more than the place in the system's list.
std::uint32_t number_of(const ServiceStatus& status, std::uint32_t first_service)
{
    return status.service % system::services_per_unit - first_service + 1;
}

void name_services(const Services& services, report::Standing& standing)
{
    for (const auto& [id, service] : services) {
        const std::string name{text_of(service.latest.name)};
        if (role_of(service.latest) == ServiceRole::voter) standing.voters[number_of(service.latest, system::first_voter_service)] = name;
        if (role_of(service.latest) == ServiceRole::detector)
            standing.lanes[number_of(service.latest, system::first_detector_service)] = name.starts_with("fdi-") ? name.substr(4) : name;
    }
}

void find_level_since(const std::vector<HealthEvent>& events, std::uint32_t unit, report::Standing& standing)
{
    if (!standing.voted) return;
    const auto owner = unit * system::services_per_unit + system::first_voter_service + standing.voted->voter - 1;
    for (const auto& event : events)
        if (event.source == owner && code_of(event) == EventCode::level_changed)
            standing.level_since_ns = std::max(standing.level_since_ns.value_or(0), event.wall_time_ns);
}

void print_services(const Services& services)
{
    fmt::print("{:<14}{:<12}{:<10}{:<12}{:<10}{:>9}{:>11}{:>11}{:>8}{:>8}{:>9}{:>10}\n", "service", "role", "state", "vendor", "transport",
               "rate/Hz", "p50/us", "p99/us", "gaps", "late", "foreign", "rejected");
    for (const auto& [id, service] : services) {
        const auto& status = service.latest;
        fmt::print("{:<14}{:<12}{:<10}{:<12}{:<10}{:>9}{:>11.0f}{:>11.0f}{:>8}{:>8}{:>9}{:>10}\n", text_of(status.name),
                   to_string(role_of(status)), to_string(state_of(status)), bus::to_string(vendor_of(status)),
                   bus::to_string(transport_of(status)), service.is_measured() ? fmt::format("{:.1f}", service.rate_hz()) : "-",
                   status.latency_s[0] * 1e6, status.latency_s[2] * 1e6, status.gaps, status.late, status.foreign, status.rejected);
    }
}

void print_events(std::vector<HealthEvent> events, std::size_t most)
{
    std::stable_sort(events.begin(), events.end(),
                     [](const HealthEvent& a, const HealthEvent& b) { return a.wall_time_ns < b.wall_time_ns; });
    const auto shown = std::min(most, events.size());
    for (auto event = events.end() - static_cast<std::ptrdiff_t>(shown); event != events.end(); ++event) {
        const auto seconds = static_cast<std::time_t>(event->wall_time_ns / 1'000'000'000);
        fmt::print("{:%H:%M:%S}.{:03}  {:<11}{:<12}{:<22}{}\n", fmt::gmtime(seconds), event->wall_time_ns / 1'000'000 % 1000,
                   to_string(static_cast<Severity>(event->severity)), text_of(event->source_name),
                   to_string(static_cast<EventCode>(event->code)), text_of(event->text));
    }
}

/// What is received of one unit. Watched for long, it forgets who has fallen silent.
struct Received {
    static constexpr std::int64_t silence_ns = 2'000'000'000;
    /// A voter's output may be discovered so much later than its status.
    static constexpr std::int64_t discovery_ns = 1'000'000'000;
    static constexpr std::size_t most_events = 2000;

    Services services;
    std::vector<HealthEvent> events;
    report::Standing standing;

    void subscribe(bus::Bus& bus, runtime::EventLoop& loop, std::uint32_t unit)
    {
        const auto now = [&loop] { return loop.clock().steady_ns(); };
        const auto take = [&loop, &bus, unit](const auto& topic, auto use) {
            using Message = typename std::decay_t<decltype(topic)>::Message;
            loop.on(bus.subscribe(topic), [unit, use](const Message& sample) {
                if (sample.unit == unit) use(sample);
            });
        };
        take(bus::topics::status, [this, now](const ServiceStatus& sample) {
            auto& its = services.try_emplace(sample.service, ReceivedService{{sample, sample}, now()}).first->second;
            if (std::exchange(its.begins_next, false)) its.first = its.latest;
            its.latest = sample;
            its.received_ns = now();
        });
        take(bus::topics::event, [this](const HealthEvent& event) {
            if (events.size() == most_events) events.erase(events.begin());
            events.push_back(event);
        });
        take(bus::topics::cluster, [this](const ClusterDescription& sample) { standing.description = sample; });
        take(bus::topics::voted, [this, now](const VotedAttitude& sample) {
            standing.voted = sample;
            voted_ns = now();
        });
        take(bus::topics::verdict, [this, now](const FaultVerdict& sample) {
            standing.verdicts[sample.detector] = sample;
            verdict_ns[sample.detector] = now();
        });
    }

    /// Rates are those since the call before.
    void begin_next(std::int64_t now_ns)
    {
        const auto is_silent = [now_ns](std::int64_t received_ns) { return now_ns - received_ns > silence_ns; };
        std::erase_if(services, [&](const auto& entry) { return is_silent(entry.second.received_ns); });
        for (auto& [id, service] : services) service.begins_next = true;
        if (standing.voted && is_silent(voted_ns)) standing.voted.reset();
        std::erase_if(standing.verdicts, [&](const auto& entry) { return is_silent(verdict_ns[entry.first]); });
    }

    /// Whether a voter has been received for so long that its output would have been, too.
    bool output_is_due(std::int64_t now_ns) const
    {
        return std::ranges::any_of(services, [now_ns](const auto& entry) {
            return role_of(entry.second.latest) == ServiceRole::voter && now_ns - entry.second.first_received_ns >= discovery_ns;
        });
    }

    std::int64_t voted_ns = 0;
    std::map<std::uint32_t, std::int64_t> verdict_ns;
};

std::vector<report::Starving> starving_of(const Received& received)
{
    std::vector<report::Interval> services;
    for (const auto& [id, service] : received.services) services.push_back(service);
    return report::find_starving(services, received.events);
}

void print(const Received& received, const StatusOptions& options, std::int64_t now_ns)
{
    if (!options.json) {
        fmt::print("{}\n{}\n", report::standing_text(received.standing, now_ns), report::starving_text(starving_of(received)));
        print_services(received.services);
        return print_events(received.events, options.events);
    }
    Json json = {{"standing", report::standing_json(received.standing, now_ns)},
                 {"starving", report::starving_json(starving_of(received))},
                 {"services", Json::array()},
                 {"events", Json::array()}};
    for (const auto& [id, service] : received.services) json["services"].push_back(message_json(service.latest));
    for (const auto& event : received.events) json["events"].push_back(message_json(event));
    fmt::print("{}\n", dump(json));
}

int status(const StatusOptions& options)
{
    auto joined = options.bus;
    joined.voted_lease_s = longest_lease_s;
    const auto bus = joined.open("quorient-status");
    const runtime::SystemClock clock;
    runtime::EventLoop loop{*bus, clock, runtime::termination_requested()};
    Received received;
    received.subscribe(*bus, loop, options.bus.unit);
    const auto show = [&] {
        name_services(received.services, received.standing);
        received.standing.output_is_due = received.output_is_due(clock.steady_ns());
        find_level_since(received.events, options.bus.unit, received.standing);
        if (options.watch && ::isatty(STDOUT_FILENO) == 1) fmt::print("\033[H\033[J");
        print(received, options, clock.wall_ns());
        return std::fflush(stdout) == 0;
    };
    const auto period_ns = nanoseconds(options.seconds);
    if (options.watch)
        loop.every(period_ns, [&] {
            if (!show()) loop.quit(ExitCode::refused);  // nobody reads it any more
            received.begin_next(clock.steady_ns());
        });
    else loop.timer([&] { loop.quit(0); }).set(clock.steady_ns() + period_ns);
    loop.run();
    if (!options.watch) show();
    if (received.services.empty())
        fmt::print(stderr, "no service of unit {} answers in domain {} on '{}'\n", options.bus.unit, options.bus.joined_domain(),
                   options.bus.interface);
    return received.services.empty() ? ExitCode::not_as_asked : ExitCode::done;
}

}  // namespace

void add_status(Program& program)
{
    auto verb = program.verb(
        "status", "Whether the attitude is good, and why; which services run, on which transport, at which rate and latency; the latest events");
    auto options = std::make_shared<StatusOptions>();
    options->bus.add_to(verb);
    verb.option("--seconds", options->seconds, "How long to listen; with --watch, how often to show")
        .within(settings::above_zero)
        .value_name("S")
        .shows_default();
    verb.option("--events", options->events, "How many events to show").shows_default();
    verb.flag("--watch", options->watch, "Go on until interrupted, and show it anew every --seconds");
    verb.flag("--json", options->json, "One JSON object; with --watch one per line each time");
    verb.footer("Example:\n  quorient status --domain 42");
    verb.not_as_asked_if("no service answers");
    verb.run([options] {
        if (const int exit_code = status(*options); exit_code != 0) throw Exit{exit_code};
    });
}

}  // namespace quorient::cli
