#include "cli/message_json.hpp"
#include "quorient/bus/settings.hpp"
#include "quorient/bus/topics.hpp"
#include "quorient/messages/meaning.hpp"
#include "quorient/messages/name.hpp"
#include "quorient/runtime/event_loop.hpp"
#include "quorient/runtime/signals.hpp"
#include "quorient/messages/words.hpp"
#include "cli/system_options.hpp"
#include "verbs.hpp"

#include <fmt/chrono.h>
#include <fmt/format.h>
#include <algorithm>
#include <map>
#include <memory>
#include <vector>

namespace quorient::cli {

namespace {

struct StatusOptions {
    BusOptions bus;
    double seconds = 2;
    std::size_t events = 20;
    bool json = false;
};

/// Status comes twice a second: two samples of a service give its rate.
struct Heard {
    ServiceStatus first;
    ServiceStatus latest;

    double rate_hz() const
    {
        const double elapsed_s = static_cast<double>(latest.wall_time_ns - first.wall_time_ns) * 1e-9;
        return elapsed_s > 0 ? static_cast<double>(latest.published - first.published) / elapsed_s : 0;
    }
};

using Services = std::map<std::uint32_t, Heard>;

void print_services(const Services& services)
{
    fmt::print("{:<14}{:<12}{:<10}{:<12}{:<10}{:>9}{:>11}{:>11}{:>8}{:>8}{:>9}{:>10}\n", "service", "role", "state", "vendor", "transport",
               "rate/Hz", "p50/us", "p99/us", "gaps", "late", "foreign", "rejected");
    for (const auto& [id, heard] : services) {
        const auto& status = heard.latest;
        fmt::print("{:<14}{:<12}{:<10}{:<12}{:<10}{:>9.1f}{:>11.0f}{:>11.0f}{:>8}{:>8}{:>9}{:>10}\n", text_of(status.name),
                   to_string(role_of(status)), to_string(state_of(status)),
                   bus::to_string(vendor_of(status)), bus::to_string(transport_of(status)),
                   heard.rate_hz(), status.latency_s[0] * 1e6, status.latency_s[2] * 1e6, status.gaps, status.late, status.foreign,
                   status.rejected);
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

int status(const StatusOptions& options)
{
    const auto bus = options.bus.open("quorient-status");
    const runtime::SystemClock clock;
    runtime::EventLoop loop{*bus, clock, runtime::termination_requested()};
    Services services;
    std::vector<HealthEvent> events;
    loop.on(bus->subscribe(bus::topics::status), [&](const ServiceStatus& sample) {
        if (sample.unit != options.bus.unit) return;
        services.try_emplace(sample.service, Heard{sample, sample}).first->second.latest = sample;
    });
    loop.on(bus->subscribe(bus::topics::event), [&](const HealthEvent& event) {
        if (event.unit == options.bus.unit) events.push_back(event);
    });
    loop.timer([&] { loop.quit(0); }).set(clock.steady_ns() + static_cast<std::int64_t>(options.seconds * 1e9));
    loop.run();
    if (options.json) {
        Json json = {{"services", Json::array()}, {"events", Json::array()}};
        for (const auto& [id, heard] : services) json["services"].push_back(message_json(heard.latest));
        for (const auto& event : events) json["events"].push_back(message_json(event));
        fmt::print("{}\n", dump(json));
    } else {
        print_services(services);
        print_events(std::move(events), options.events);
    }
    if (services.empty())
        fmt::print(stderr, "no service of unit {} answers in domain {} on '{}'\n", options.bus.unit, options.bus.domain,
                   options.bus.interface);
    return services.empty() ? 1 : 0;
}

}  // namespace

void add_status(Program& program)
{
    auto verb = program.verb("status", "Who is alive, on which transport, at which rate and latency, and the latest events");
    auto options = std::make_shared<StatusOptions>();
    options->bus.add_to(verb);
    verb.option("--seconds", options->seconds, "How long to listen").shows_default();
    verb.option("--events", options->events, "How many events to show").shows_default();
    verb.flag("--json", options->json, "One JSON object");
    verb.footer("Example:\n  quorient status --domain 42");
    verb.run([options] {
        if (const int exit_code = status(*options); exit_code != 0) throw Exit{exit_code};
    });
}

}  // namespace quorient::cli
