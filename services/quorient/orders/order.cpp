#include "order.hpp"

#include "quorient/bus/topics.hpp"
#include "quorient/messages/codes.hpp"
#include "quorient/messages/meaning.hpp"
#include "quorient/messages/name.hpp"
#include "quorient/messages/time.hpp"

#include <fmt/format.h>

namespace quorient::cli {

namespace {

constexpr std::int64_t look_period_ns = 20'000'000;

// All matches of a domain come within about a second of each other.
constexpr std::int64_t discovery_ns = 1'200'000'000;

// A status comes twice a second: so long another service may be found that has to receive this. A unit has one sensor publisher.
constexpr std::int64_t all_found_ns = 600'000'000;

// Members of a secured system first prove who they are, so they are found later.
constexpr std::int64_t all_authenticated_ns = 2'000'000'000;

constexpr std::int64_t repetition_ns = 100'000'000;

ServiceRole concerned_role(std::uint8_t action)
{
    switch (static_cast<CommandAction>(action)) {
        case CommandAction::readmit:
            return ServiceRole::detector;
        case CommandAction::reset_attitude:
            return ServiceRole::integrator;
        default:
            return ServiceRole::sensor;
    }
}

}  // namespace

Order::Order(const FaultCommand& command, bus::Bus& bus, runtime::EventLoop& loop, bool secured)
    : command_(command),
      loop_(loop),
      commands_(bus.advertise(bus::topics::command)),
      of_a_frame_(action_of(command) == CommandAction::reset_attitude),
      search_ns_(concerned_role(command.action) == ServiceRole::sensor ? 0 : secured ? all_authenticated_ns : all_found_ns),
      begin_ns_(loop.clock().steady_ns())
{
    loop_.on(bus.subscribe(bus::topics::frame), [this](const SensorFrame& frame) {
        if (frame.unit == command_.unit) newest_ = frame.sequence;
    });
    loop_.on(bus.subscribe(bus::topics::status), [this](const ServiceStatus& status) { on_status(status); });
    loop_.on(bus.subscribe(bus::topics::event), [this](const HealthEvent& event) { on_event(event); });
    loop_.every(look_period_ns, [this] { look(); });
    loop_.timer([this] { give_up(); }).set(begin_ns_ + nanoseconds(patience_s));
}

void Order::look()
{
    const auto now_ns = loop_.clock().steady_ns();
    const bool all_answered = !answered_.empty() && unanswered().empty();
    if (all_answered && now_ns - *first_given_ns_ >= search_ns_) return loop_.quit(refused_ ? 1 : 0);
    if (!all_answered && is_ready(now_ns) && now_ns - given_ns_ >= repetition_ns) give(now_ns);
}

bool Order::is_ready(std::int64_t now_ns)
{
    return commands_.status().matched > 0 && now_ns - begin_ns_ > discovery_ns && (newest_ || !of_a_frame_);
}

void Order::give(std::int64_t now_ns)
{
    if (!first_given_ns_) {
        first_given_ns_ = now_ns;
        if (of_a_frame_) command_.value = static_cast<double>(*newest_);
    }
    given_ns_ = now_ns;
    commands_.publish(command_);
}

void Order::on_status(const ServiceStatus& status)
{
    if (status.unit != command_.unit || status.role != octet(concerned_role(command_.action))) return;
    if (state_of(status) == ServiceState::stopping) concerned_.erase(status.service);
    else concerned_.try_emplace(status.service, text_of(status.name));
}

void Order::on_event(const HealthEvent& event)
{
    if (event.request != command_.request || !answered_.insert(event.source).second) return;
    fmt::print("{}: {}\n", text_of(event.source_name), text_of(event.text));
    refused_ = refused_ || code_of(event) == EventCode::command_refused;
}

std::string Order::unanswered() const
{
    std::string names;
    for (const auto& [service, name] : concerned_) {
        if (answered_.count(service) == 0) names += (names.empty() ? "" : ", ") + name;
    }
    return names;
}

void Order::give_up()
{
    const auto silent = unanswered();
    if (answered_.empty())
        fmt::print(stderr, "no service of unit {} answered within {} s{}\n", command_.unit, patience_s,
                   of_a_frame_ && !newest_ ? ": there are no frames" : "");
    else if (!silent.empty()) fmt::print(stderr, "{} did not answer within {} s: give the order again\n", silent, patience_s);
    loop_.quit(answered_.empty() || !silent.empty() || refused_ ? 1 : 0);
}

}  // namespace quorient::cli
