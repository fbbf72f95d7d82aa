#include "monitor_service.hpp"

#include "quorient/messages/meaning.hpp"

#include <algorithm>
#include <chrono>
#include <thread>

namespace quorient::monitor {
namespace {

constexpr std::int64_t tick_period_ns = 100'000'000;

/// Samples are read in batches: a wake-up for each of them would cost most of this process's time. A reader keeps 64 samples of each
/// writer, so none is lost at up to 6 kHz.
constexpr std::chrono::milliseconds rest{10};

/// A service that has just been matched may miss the first ones; those that had it before ignore a request that they know.
constexpr int order_repetitions = 15;

}  // namespace

MonitorService::MonitorService(const system::System& system, Exchange& exchange, bus::Bus& bus, runtime::EventLoop& loop)
    : exchange_(exchange),
      loop_(loop),
      collector_(system),
      unit_(system.unit),
      heartbeat_(runtime::Heartbeat::open(system.web_monitor->process.node.name)),
      service_manager_(runtime::ServiceManager::from_environment())
{
    subscribe(bus, loop);
    if (system.web_monitor->allow_orders) commands_.emplace(bus.advertise(bus::topics::command));
    loop.every(tick_period_ns, [this] { hand_over(); });
    if (commands_) loop.every(tick_period_ns, [this] { pass_orders(); });
    loop.when_idle([] {
        std::this_thread::sleep_for(rest);
        return false;
    });
    if (service_manager_) service_manager_->ready();
}

void MonitorService::subscribe(bus::Bus& bus, runtime::EventLoop& loop)
{
    const auto now = [&loop] { return loop.clock().steady_ns(); };
    loop.on(bus.subscribe(bus::topics::cluster), [this](const ClusterDescription& m) { collector_.on_description(m); });
    loop.on(bus.subscribe(bus::topics::truth), [this](const TruthState& m) { collector_.on_truth(m); });
    loop.on(bus.subscribe(bus::topics::verdict), [this, now](const FaultVerdict& m) { collector_.on_verdict(m, now()); });
    loop.on(bus.subscribe(bus::topics::diagnosis), [this](const FaultDiagnosis& m) { collector_.on_diagnosis(m); });
    loop.on(bus.subscribe(bus::topics::voted), [this, now](const VotedAttitude& m) {
        if (m.unit == unit_) newest_frame_ = m.sequence;
        collector_.on_voted(m, now());
    });
    loop.on(bus.subscribe(bus::topics::event), [this](const HealthEvent& m) { on_event(m); });
    loop.on(bus.subscribe(bus::topics::status), [this, now](const ServiceStatus& m) { collector_.on_status(m, now()); });
}

void MonitorService::hand_over()
{
    const auto now_ns = loop_.clock().steady_ns();
    const auto& tick = collector_.tick(now_ns, loop_.clock().wall_ns());
    // The monitor's own life, not the pipeline's: it has to show that frames are missing.
    if (heartbeat_) heartbeat_->beat(now_ns, tick.number);
    if (service_manager_) service_manager_->frame_handled(now_ns);
    if (exchange_.offer(tick)) collector_.begin();
    else collector_.defer();
}

void MonitorService::on_event(const HealthEvent& event)
{
    if (underway_ && event.request != 0 && event.request == underway_->command.request)
        underway_->repetitions = std::max(underway_->repetitions, order_repetitions / 2);  // others may still wait for it
    collector_.on_event(event);
}

void MonitorService::pass_orders()
{
    if (!underway_) {
        const auto order = exchange_.next_order();
        if (!order) return;
        underway_.emplace(Underway{*order});
        underway_->command.unit = unit_;
        underway_->command.request = static_cast<std::uint64_t>(loop_.clock().wall_ns());
        if (action_of(*order) == CommandAction::reset_attitude) underway_->command.value = static_cast<double>(newest_frame_);
    }
    commands_->publish(underway_->command);
    if (++underway_->repetitions >= order_repetitions) underway_.reset();
}

}  // namespace quorient::monitor
