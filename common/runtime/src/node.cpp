#include "quorient/messages/meaning.hpp"
#include "quorient/messages/name.hpp"
#include "quorient/runtime/node.hpp"

#include "quorient/bus/topics.hpp"
#include "quorient/messages/time.hpp"
#include "quorient/runtime/options.hpp"

#include <fmt/format.h>
#include <spdlog/spdlog.h>
#include <unistd.h>
#include <algorithm>
#include <array>

namespace quorient::runtime {

namespace {

constexpr std::int64_t status_period_ns = second_ns / 2;
/// Nobody asks more often whether frames are fresh, and each beat is a system call.
constexpr std::int64_t heartbeat_period_ns = 20'000'000;
constexpr std::int64_t readiness_period_ns = 20'000'000;
constexpr std::int64_t match_patience_ns = 5 * second_ns;
constexpr std::int64_t day_ns = 24 * 3600 * second_ns;
constexpr std::int64_t expiry_warning_ns = 30 * day_ns;

spdlog::level::level_enum level_of(Severity severity)
{
    switch (severity) {
        case Severity::warning_low:
        case Severity::warning_high:
            return spdlog::level::warn;
        case Severity::fatal:
            return spdlog::level::critical;
        default:
            return spdlog::level::info;
    }
}

std::string describe(const bus::Sender& sender)
{
    if (sender.authenticated) return fmt::format("{} (certificate)", sender.name);
    if (!sender.name.empty()) return fmt::format("'{}' (unconfirmed name)", sender.name);
    return sender.guid.empty() ? std::string{"an unknown sender"} : fmt::format("participant {}", sender.guid);
}

struct OrderRule {
    CommandAction action;
    const char* word;
    const char* key;  ///< under `commands` in the system file
    bool OrderSettings::*permitted;
};
constexpr std::array order_rules{OrderRule{CommandAction::inject, "inject", "inject", &OrderSettings::inject},
                                 OrderRule{CommandAction::clear, "inject --clear", "inject", &OrderSettings::inject},
                                 OrderRule{CommandAction::readmit, "readmit", "readmit", &OrderSettings::readmit},
                                 OrderRule{CommandAction::reset_attitude, "reset", "reset", &OrderSettings::reset}};

const OrderRule* rule_for(CommandAction action)
{
    const auto rule = std::ranges::find(order_rules, action, &OrderRule::action);
    return rule == order_rules.end() ? nullptr : &*rule;
}

}  // namespace

Node::Node(NodeSettings settings, bus::Bus& bus, EventLoop& loop)
    : settings_(std::move(settings)),
      bus_(bus),
      loop_(loop),
      events_(bus.advertise(bus::topics::event)),
      statuses_(bus.advertise(bus::topics::status)),
      started_ns_(loop.clock().steady_ns())
{
    status_.unit = settings_.unit;
    status_.service = settings_.service;
    status_.process = static_cast<std::uint32_t>(::getpid());
    status_.role = octet(settings_.role);
    status_.state = octet(ServiceState::starting);
    status_.vendor = octet(bus.vendor());
    copy_text(settings_.name, status_.name);
    copy_text(version(), status_.version);
    if (settings_.heartbeat) {
        heartbeat_ = Heartbeat::open(settings_.name);
        service_manager_ = ServiceManager::from_environment();
        if (!heartbeat_)
            spdlog::warn("{}: no heartbeat file in {}: `quorient health` will not see this service", settings_.name,
                         run_directory().string());
    }
    loop_.every(status_period_ns, [this] {
        look_at_endpoints();
        look_at_shared_memory();
        look_at_identity();
        look_at_refusals();
        publish_status();
    });
}

Node::~Node()
{
    main_output_ = nullptr;  // the service's endpoints are gone already
    report(EventCode::goodbye, Severity::info, {status_.epoch, status_.sequence}, 0, "stops in order");
    set_state(ServiceState::stopping);
}

void Node::report(EventCode code, Severity severity, Identity identity, std::uint32_t axes, std::string_view text, std::uint64_t request)
{
    HealthEvent event;
    event.epoch = identity.epoch;
    event.sequence = identity.sequence;
    event.wall_time_ns = clock().wall_ns();
    event.event_number = ++event_number_;
    event.request = request;
    event.unit = settings_.unit;
    event.source = settings_.service;
    event.axes = axes;
    event.code = octet(code);
    event.severity = octet(severity);
    copy_text(settings_.name, event.source_name);
    copy_text(text, event.text);
    events_.publish(event);
    if (settings_.log_events) spdlog::log(level_of(severity), "{}: {}", settings_.name, text);
}

bool Node::report_throttled(EventCode code, Severity severity, Identity identity, std::uint32_t axes, std::string_view text)
{
    auto& last = last_reported_ns_[octet(code)];
    const auto now = clock().steady_ns();
    if (last != 0 && now - last < second_ns) return false;
    last = now;
    report(code, severity, identity, axes, text);
    return true;
}

void Node::on_order(std::initializer_list<CommandAction> kinds, std::function<void(const FaultCommand&)> handler)
{
    const auto obey = [this, kinds = std::vector(kinds), handler = std::move(handler)](const FaultCommand& order) {
        const auto action = action_of(order);
        const bool concerned = order.unit == settings_.unit && std::find(kinds.begin(), kinds.end(), action) != kinds.end();
        if (!concerned || !is_new(order.request)) return;
        if (permits(action)) handler(order);
        else refuse(order);
    };
    orders_ = &loop_.on(bus_.subscribe(bus::topics::command), obey);
}

bool Node::permits(CommandAction action) const
{
    const auto* rule = rule_for(action);
    return rule && settings_.orders.*rule->permitted;
}

void Node::refuse(const FaultCommand& order)
{
    const auto* rule = rule_for(action_of(order));
    report(EventCode::command_refused, Severity::warning_high, {status_.epoch, status_.sequence}, order.axes,
           fmt::format("refuses {} from {}: the system file has commands.{}: refused", rule->word, describe(orders_->sender()), rule->key),
           order.request);
}

/// Requests are numbered by who gives them; 0 is nobody's number.
bool Node::is_new(std::uint64_t request)
{
    if (request == 0) return true;
    if (std::find(request_.begin(), request_.end(), request) != request_.end()) return false;
    request_[request_count_++ % request_.size()] = request;
    return true;
}

void Node::set_state(ServiceState state)
{
    if (this->state() == state) return;
    status_.state = octet(state);
    if (service_manager_ && (state == ServiceState::ready || state == ServiceState::running)) service_manager_->ready();
    if (service_manager_ && state == ServiceState::stopping) service_manager_->stopping();
    publish_status();
}

void Node::ready_when(std::function<bool()> has_all_it_needs)
{
    loop_.until(readiness_period_ns, [this, has_all_it_needs = std::move(has_all_it_needs)] {
        if (state() == ServiceState::starting && !has_all_it_needs()) return false;
        if (state() == ServiceState::starting) set_state(ServiceState::ready);
        return true;
    });
}

void Node::handled(Identity identity, std::int64_t arrival_ns)
{
    const auto now = clock().steady_ns();
    status_.epoch = identity.epoch;
    status_.sequence = identity.sequence;
    ++status_.received;
    latency_ns_[latency_count_++ % latency_ns_.size()] = now - arrival_ns;
    if (heartbeat_ && now - beat_ns_ >= heartbeat_period_ns) {
        heartbeat_->beat(now, status_.received);
        beat_ns_ = now;
    }
    if (service_manager_) service_manager_->frame_handled(now);
}

void Node::watch(std::string_view what, std::function<bus::EndpointStatus()> status, bool must_match)
{
    watched_.push_back({std::string{what}, std::move(status), must_match});
}

void Node::look_at_endpoints()
{
    for (auto& endpoint : watched_) {
        const auto now = endpoint.status();
        const Identity none;
        if (now.incompatible > endpoint.incompatible) {
            endpoint.incompatible = now.incompatible;
            report(EventCode::incompatible_qos, Severity::warning_high, none, 0,
                   fmt::format("{}: a peer asks for another {}; see the QoS table in idl/README.md", endpoint.what, now.policy));
        }
        if (now.asked != now.transport && now.asked != Transport::unknown && !endpoint.reported_fallback) {
            endpoint.reported_fallback = true;
            report(EventCode::transport_fallback, Severity::warning_high, none, 0,
                   fmt::format("{} goes by {}: {} was asked for and is not available", endpoint.what, bus::to_string(now.transport),
                               bus::to_string(now.asked)));
        }
        if (now.refused > endpoint.refused) {
            endpoint.refused = now.refused;
            report(EventCode::shared_memory_lost, Severity::warning_high, {status_.epoch, status_.sequence}, 0,
                   fmt::format("{}: {} samples not sent in all: {} has no room (iceoryx: more chunks in roudi.toml)", endpoint.what,
                               now.refused, bus::to_string(now.transport)));
        }
        if (now.matched > 0) endpoint.must_match = false;
        if (endpoint.must_match && !endpoint.reported_unmatched && clock().steady_ns() - started_ns_ > match_patience_ns) {
            endpoint.reported_unmatched = true;
            report(EventCode::no_match, Severity::warning_high, none, 0,
                   fmt::format("{} matched nobody for 5 s: is the peer running, in this domain, on this network, with this IDL?",
                               endpoint.what));
        }
    }
}

void Node::look_at_shared_memory()
{
    if (reported_shared_memory_lost_ || !bus_.shared_memory_lost()) return;
    reported_shared_memory_lost_ = true;
    report(EventCode::shared_memory_lost, Severity::warning_high, {status_.epoch, status_.sequence}, 0,
           "iceoryx's daemon is gone or another one: what starts from now on shares no memory with this process");
}

/// Warns at the start and once a day.
void Node::look_at_identity()
{
    if (settings_.identity_expires_ns == 0 || (expiry_reported_ns_ != 0 && clock().steady_ns() - expiry_reported_ns_ < day_ns)) return;
    const auto left_ns = settings_.identity_expires_ns - clock().wall_ns();
    if (left_ns > expiry_warning_ns) return;
    expiry_reported_ns_ = clock().steady_ns();
    const bool expired = left_ns <= 0;
    report(EventCode::identity_expires, expired ? Severity::warning_high : Severity::warning_low, {status_.epoch, status_.sequence}, 0,
           expired
               ? fmt::format(
                     "its certificate has expired: processes that start from now on refuse it; quorient keys --renew {}, then restart it",
                     settings_.name)
               : fmt::format("its certificate expires in {} days: quorient keys --renew {}, then restart it", left_ns / day_ns,
                             settings_.name));
}

void Node::look_at_refusals()
{
    for (const auto& [reason, text] : bus_.refusals())
        report(reason == bus::RefusalReason::security ? EventCode::security : EventCode::other_contract, Severity::warning_high,
               {status_.epoch, status_.sequence}, 0, text);
}

void Node::publish_status()
{
    status_.wall_time_ns = clock().wall_ns();
    if (main_output_) {
        const auto output = main_output_();
        status_.matched = output.matched;
        status_.transport = octet(output.transport);
    }
    const auto count = std::min(latency_count_, latency_ns_.size());
    if (count > 0) {
        const auto begin = latency_ns_.begin();
        std::sort(begin, begin + static_cast<std::ptrdiff_t>(count));
        const auto quantile = [&](double q) {
            return static_cast<double>(latency_ns_[static_cast<std::size_t>(q * static_cast<double>(count - 1))]) * 1e-9;
        };
        status_.latency_s = {quantile(0.5), quantile(0.9), quantile(0.99), quantile(1)};
    }
    latency_count_ = 0;
    statuses_.publish(status_);
}

}  // namespace quorient::runtime
