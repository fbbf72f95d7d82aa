#include "report/starvation.hpp"

#include "quorient/messages/meaning.hpp"
#include "quorient/messages/name.hpp"

#include <fmt/format.h>
#include <algorithm>

namespace quorient::report {

namespace {

/// One that had given out nothing before has only begun, or waits for its input as a voter does for attitudes.
bool gave_before(const Interval& service)
{
    return service.first.published > 0;
}

/// The counts of two processes are not of the same moment, and a status comes twice a second.
constexpr double enough = 0.95;

constexpr std::string_view too_little_time =
    "it gets too little processor time, or its input does not arrive: see its gaps, and real-time priority in deploy/README.md";

constexpr std::string_view leaves_frames_out = "it is overloaded and leaves frames out, so that the others are not old: a lower rate, compose, shared memory, or more processors";

/// OVERLOADED comes when that begins and when it ends.
bool is_shedding(std::uint32_t service, std::span<const HealthEvent> events)
{
    const HealthEvent* newest = nullptr;
    for (const auto& event : events) {
        if (event.source == service && code_of(event) == EventCode::overloaded && (!newest || event.wall_time_ns >= newest->wall_time_ns))
            newest = &event;
    }
    return newest && newest->severity != octet(Severity::info);
}

bool gives_one_per_frame(const ServiceStatus& status)
{
    const auto role = role_of(status);
    return role == ServiceRole::detector || role == ServiceRole::integrator || role == ServiceRole::voter;
}

/// The sensor; without one, the quickest service. Null where nothing is measured.
const Interval* reference(std::span<const Interval> services)
{
    const Interval* quickest = nullptr;
    for (const auto& service : services) {
        if (service.rate_hz() <= 0) continue;
        if (role_of(service.latest) == ServiceRole::sensor) return &service;
        if (gives_one_per_frame(service.latest) && (!quickest || service.rate_hz() > quickest->rate_hz())) quickest = &service;
    }
    return quickest;
}

/// Either count may be of one frame more or less than the other, which matters where few frames passed.
bool falls_short(const Interval& service, const Interval& sensor)
{
    const double due = sensor.rate_hz() * service.elapsed_s();
    const double counted_s = std::min(service.elapsed_s(), sensor.elapsed_s());
    const double uncertain = 1 + service.elapsed_s() / counted_s;
    return service.rate_hz() * service.elapsed_s() < std::min(enough * due, due - uncertain);
}

}  // namespace

bool Interval::is_measured() const
{
    return latest.process == first.process && latest.wall_time_ns > first.wall_time_ns && latest.published >= first.published;
}

double Interval::rate_hz() const
{
    if (!is_measured()) return 0;
    return static_cast<double>(latest.published - first.published) / elapsed_s();
}

double Interval::elapsed_s() const
{
    return static_cast<double>(latest.wall_time_ns - first.wall_time_ns) * 1e-9;
}

std::vector<Starving> find_starving(std::span<const Interval> services, std::span<const HealthEvent> events)
{
    std::vector<Starving> found;
    const auto* sensor = reference(services);
    if (!sensor) return found;
    for (const auto& service : services) {
        if (!gives_one_per_frame(service.latest) || state_of(service.latest) != ServiceState::running) continue;
        if (!gave_before(service) || !service.is_measured() || !falls_short(service, *sensor)) continue;
        found.push_back({std::string{text_of(service.latest.name)}, service.rate_hz(), sensor->rate_hz(),
                         is_shedding(service.latest.service, events)});
    }
    return found;
}

std::string starving_text(std::span<const Starving> starving)
{
    std::string text;
    for (const auto& [service, rate_hz, sensor_hz, sheds] : starving)
        text += fmt::format("STARVING: {} gives {:.0f} of {:.0f} frames per second: {}\n", service, rate_hz, sensor_hz,
                            sheds ? leaves_frames_out : too_little_time);
    return text;
}

nlohmann::ordered_json starving_json(std::span<const Starving> starving)
{
    auto list = nlohmann::ordered_json::array();
    for (const auto& [service, rate_hz, sensor_hz, sheds] : starving)
        list.push_back({{"service", service}, {"rate_hz", rate_hz}, {"sensor_hz", sensor_hz}, {"overloaded", sheds}});
    return list;
}

}  // namespace quorient::report
