#include "sensor_publisher.hpp"

#include "quorient/messages/meaning.hpp"
#include "quorient/messages/name.hpp"
#include "quorient/messages/time.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

namespace quorient::sensor {

namespace {

/// A publisher that is later than this was stopped, not merely scheduled late: it skips instead of sending a burst.
constexpr std::int64_t longest_catch_up_intervals = 4;

/// After the last frame, for the slowest consumer to take it.
constexpr std::int64_t linger_ns = 500'000'000;

constexpr std::int64_t notice_period_ns = 500'000'000;

}  // namespace

SensorPublisher::SensorPublisher(const system::SensorSettings& settings, std::unique_ptr<FrameSource> source, bus::Bus& bus,
                                 runtime::EventLoop& loop)
    : settings_(settings),
      source_(std::move(source)),
      node_(settings.process.node, bus, loop),
      descriptions_(bus.advertise(bus::topics::cluster)),
      frames_(bus.advertise(bus::topics::frame)),
      truths_(bus.advertise(bus::topics::truth)),
      wait_timer_(loop.timer([this] { start(); })),
      frame_timer_(loop.timer([this] { tick(); })),
      end_timer_(loop.timer([&loop] { loop.quit(0); })),
      missing_(settings.consumers.begin(), settings.consumers.end()),
      interval_ns_(nanoseconds(source_->description().interval_s / settings.source.speed))
{
    node_.main_output([this] { return frames_.status(); });
    node_.watch(
        bus::topics::frame.spec.name, [this] { return frames_.status(); }, true);
    loop.on(bus.subscribe(bus::topics::status), [this](const ServiceStatus& status) { on_status(status); });
    node_.on_order({CommandAction::inject, CommandAction::clear}, [this](const FaultCommand& command) { on_command(command); });
    source_->attach(bus, loop);
    loop.every(notice_period_ns, [this] { report_notices(); });  // also while the first frame cannot begin
    descriptions_.publish(source_->description());
    node_.set_state(ServiceState::ready);
    wait_timer_.set(loop.clock().steady_ns() + nanoseconds(settings.wait_s));
}

void SensorPublisher::on_status(const ServiceStatus& status)
{
    if (started_ || status.unit != settings_.process.node.unit || status.state < octet(ServiceState::ready)) return;
    const auto waited_for = missing_.find(text_of(status.name));
    if (waited_for == missing_.end()) return;
    missing_.erase(waited_for);
    if (missing_.empty()) start();
}

void SensorPublisher::start()
{
    if (started_) return;
    started_ = true;
    wait_timer_.cancel();
    if (!missing_.empty())
        node_.report(EventCode::consumers_missing, Severity::warning_high, {source_->description().epoch, 0}, 0,
                     fmt::format("starts after {} s without {}", settings_.wait_s, fmt::join(missing_, ", ")));
    node_.report(EventCode::started, Severity::info, {source_->description().epoch, 0}, 0,
                 fmt::format("{} {} at {:.4g} Hz", source_->description().axis_count, unit_kind(kind_of(source_->description())).axes,
                             1 / source_->description().interval_s));
    node_.set_state(ServiceState::running);
    start_ns_ = node_.clock().steady_ns();
    frame_timer_.set(due_ns(0));
}

/// A frame is due at the end of its interval.
std::int64_t SensorPublisher::due_ns(std::uint64_t sequence) const
{
    return start_ns_ + static_cast<std::int64_t>(sequence + 1) * interval_ns_;
}

double SensorPublisher::scenario_s() const
{
    return static_cast<double>(truth_.sample_time_ns) * 1e-9;
}

void SensorPublisher::tick()
{
    const auto now = node_.clock().steady_ns();
    const auto late_intervals = (now - due_ns(next_)) / interval_ns_;
    if (late_intervals > longest_catch_up_intervals) next_ += static_cast<std::uint64_t>(late_intervals);
    if (!publish(next_)) {
        const auto remarks = source_->remarks();
        node_.report(EventCode::goodbye, Severity::info, identity_of(frame_), 0,
                     fmt::format("ended{}{}", remarks.empty() ? "" : ": ", remarks));
        end_timer_.set(now + linger_ns);
        return;
    }
    ++next_;
    frame_timer_.set(due_ns(next_));
}

void SensorPublisher::report_notices()
{
    while (const auto notice = source_->notice()) node_.report(notice->code, notice->severity, identity_of(frame_), notice->axes, notice->text);
}

bool SensorPublisher::publish(std::uint64_t sequence)
{
    const auto arrival = node_.clock().steady_ns();
    const auto described = source_->description().revision;
    const auto advance = source_->advance_to(sequence, frame_, truth_);
    if (source_->description().revision != described) descriptions_.publish(source_->description());
    report_notices();
    switch (advance) {
        case Advance::end:
            return false;
        case Advance::not_yet:
            start_ns_ = arrival - static_cast<std::int64_t>(sequence) * interval_ns_;  // the same sequence, an interval later
            --next_;
            return true;
        case Advance::nothing:
            return true;
        case Advance::frame:
            break;
    }
    frame_.stamp_ns[static_cast<std::size_t>(Hop::sensor)] = node_.clock().steady_ns();  // also unasked: it shows consumers whether they keep up
    // Truth first: a monitor that holds an attitude then already holds what to compare it with.
    truths_.publish(truth_);
    if (frames_.publish(frame_)) ++node_.status().published;
    node_.handled(identity_of(frame_), arrival);
    return true;
}

void SensorPublisher::on_command(const FaultCommand& command)
{
    const auto identity = identity_of(frame_);
    if (action_of(command) == CommandAction::inject) {
        const auto fault = simulation::from_command(command, scenario_s());
        const auto added = source_->faults().add(fault);
        if (added)
            node_.report(EventCode::fault_injected, Severity::info, identity, command.axes, "will inject " + simulation::to_string(fault),
                         command.request);
        else node_.report(EventCode::command_refused, Severity::warning_low, identity, command.axes, added.error(), command.request);
    } else {
        if (command.axes == 0) source_->faults().clear();
        else source_->faults().clear(command.axes);
        node_.report(EventCode::fault_cleared, Severity::info, identity, command.axes, "faults cleared", command.request);
    }
}

}  // namespace quorient::sensor
