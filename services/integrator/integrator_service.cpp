#include "integrator_service.hpp"

#include "quorient/geometry/sensor_cluster.hpp"
#include "quorient/messages/meaning.hpp"
#include "quorient/messages/time.hpp"

#include <fmt/format.h>
#include <utility>

namespace quorient::integrator {

namespace {

/// Directions of one axis in two descriptions of the same sensors differ by less than this: more than rounding, less than any mounting.
constexpr double largest_axis_change = 1e-6;

}  // namespace

IntegratorService::IntegratorService(const system::IntegratorProcess& settings, bus::Bus& bus, runtime::EventLoop& loop)
    : settings_(settings),
      node_(settings.process.node, bus, loop),
      attitudes_(bus.advertise(bus::topics::attitude)),
      shedding_(node_, "attitudes"),
      outlet_(shedding_, loop, [this](const AttitudeState& attitude) { node_.status().published += attitudes_.publish(attitude) ? 1 : 0; }),
      patience_timer_(loop.timer([this] { publish_pending(); })),
      intake_(settings.process.node.unit, settings.kind),
      intake_report_(node_),
      events_(node_),
      resets_(node_)
{
    node_.main_output([this] { return attitudes_.status(); });
    node_.watch(
        bus::topics::attitude.spec.name, [this] { return attitudes_.status(); }, true);
    loop.on(bus.subscribe(bus::topics::cluster), [this](const ClusterDescription& description) { on_description(description); });
    loop.on(bus.subscribe(bus::topics::voter_output), [this](const VotedAttitude& voted) { on_voted(voted); });
    node_.on_order({CommandAction::reset_attitude}, [this](const FaultCommand& command) { on_command(command); });
    verdicts_ = &loop.on(bus.subscribe(bus::topics::verdict, {.reach = settings.verdicts_from}), [this](const FaultVerdict& verdict) { on_verdict(verdict); });
    frames_ = &loop.on(bus.subscribe(bus::topics::frame), [this](const SensorFrame& frame) { on_frame(frame); });
    node_.watch(
        bus::topics::frame.spec.name, [this] { return frames_->status(); }, true);
    node_.watch(
        bus::topics::verdict.spec.name, [this] { return verdicts_->status(); }, true);
    node_.ready_when([this] {
        return intake_.described() && frames_->status().matched > 0 && verdicts_->status().matched > 0 && attitudes_.status().matched > 0;
    });
    loop.when_idle([this] { return integrator_ && integrator_->work(); });
}

/// The configured attitude was valid at the first start. For a later epoch only an attitude measured at its start counts.
void IntegratorService::on_description(const ClusterDescription& description)
{
    intake_.describe(description);
    const bool measured = initial_attitude_of(description) == InitialAttitude::measured;
    if (integrator_ && measured && description.unit == settings_.process.node.unit && description.epoch > events_.last().epoch)
        integrator_->begin_epoch(description.epoch, description.initial_attitude);
    handle_accepted();
}

void IntegratorService::on_frame(const SensorFrame& frame)
{
    arrival_ns_ = node_.clock().steady_ns();
    if (!intake_.offer(frame, arrival_ns_)) return;
    handle_accepted();
    intake_report_.update(intake_);
}

void IntegratorService::handle_accepted()
{
    while (const auto* accepted = intake_.next()) {
        publish_pending();
        if (!integrator_ && !prepare(*intake_.description(), accepted->frame.sequence)) continue;
        if (accepted->new_description) follows_ = same_axes(*intake_.description());
        if (follows_) integrate(accepted->frame);
    }
}

/// The configured attitude is that at the start of sequence 0. A process that comes later takes over the voted attitude.
bool IntegratorService::prepare(const ClusterDescription& description, std::uint64_t first_sequence)
{
    auto integration = settings_.integration;
    integration.initialised = first_sequence == 0 && !first_voted_;
    if (initial_attitude_of(description) != InitialAttitude::unknown) integration.initial_attitude = description.initial_attitude;
    auto cluster = geometry::make_cluster(description);
    if (!cluster) {
        // The publisher may correct its description, so this process waits. Settings that fit no cluster end it.
        node_.report_throttled(EventCode::rejected_input, Severity::fatal, {description.epoch, 0}, 0,
                               fmt::format("a description is refused: {}", cluster.error()));
        return false;
    }
    auto made = attitude::Integrator::make(integration, *cluster);
    if (!made) {
        node_.report(EventCode::rejected_input, Severity::fatal, {description.epoch, 0}, 0, made.error());
        node_.loop().quit(2);
        return false;
    }
    integrator_.emplace(std::move(*made));
    axes_ = cluster->axes;
    if (first_voted_) integrator_->on_voted(*first_voted_);
    if (verdict_) integrator_->apply(*verdict_);
    return true;
}

/// The history holds increments of these axes. A publisher that returns with other axes needs lanes that start anew.
bool IntegratorService::same_axes(const ClusterDescription& description)
{
    const auto cluster = geometry::make_cluster(description);
    if (cluster && cluster->axes.rows() == axes_.rows() && cluster->axes.isApprox(axes_, largest_axis_change)) return true;
    node_.report(EventCode::rejected_input, Severity::fatal, {description.epoch, 0}, 0,
                 cluster ? "the description has other axes than the one this lane started with: restart the lane to follow it"
                         : fmt::format("a description is refused: {}", cluster.error()));
    return false;
}

void IntegratorService::integrate(const SensorFrame& frame)
{
    shedding_.see(identity_of(frame), frame.stamp_ns, frame.interval_s, arrival_ns_);
    integrator_->add(frame);
    pending_ = identity_of(frame);
    stamps_ = frame.stamp_ns;
    stamps_[static_cast<std::size_t>(Hop::integrator_in)] = node_.settings().stamps ? arrival_ns_ : 0;
    node_.set_state(ServiceState::running);
    // A frame that is left out waits for no verdict.
    if (shedding_.leaves_out(*pending_) || (verdict_ && identity_of(*verdict_) >= *pending_)) publish_pending();
    else patience_timer_.set(arrival_ns_ + nanoseconds(settings_.patience * frame.interval_s));
}

void IntegratorService::on_verdict(const FaultVerdict& verdict)
{
    if (verdict.unit != settings_.process.node.unit || verdict.detector != settings_.detector) return;
    if (verdict_ && identity_of(verdict) <= identity_of(*verdict_)) return;
    const auto arrived_ns = node_.stamp();
    verdict_ = verdict;
    if (!integrator_) return;
    integrator_->apply(verdict);
    if (pending_ && identity_of(verdict) >= *pending_) {
        // The frame waited for its verdict: its latency counts from the verdict's arrival.
        stamps_[static_cast<std::size_t>(Hop::integrator_in)] = arrived_ns;
        stamps_[static_cast<std::size_t>(Hop::detector_in)] = verdict.stamp_ns[static_cast<std::size_t>(Hop::detector_in)];
        stamps_[static_cast<std::size_t>(Hop::detector_out)] = verdict.stamp_ns[static_cast<std::size_t>(Hop::detector_out)];
        publish_pending();
    }
}

void IntegratorService::publish_pending()
{
    if (!pending_) return;
    pending_.reset();
    patience_timer_.cancel();
    auto attitude = integrator_->publish();
    attitude.stamp_ns = stamps_;
    attitude.stamp_ns[static_cast<std::size_t>(Hop::integrator_out)] = node_.stamp();
    outlet_.give(attitude);
    node_.handled(identity_of(attitude), arrival_ns_);
    events_.report_changes(attitude, *intake_.description(), integrator_->history_too_short());
    resets_.on_published(*integrator_, identity_of(attitude));
}

void IntegratorService::on_voted(const VotedAttitude& voted)
{
    if (voted.unit != settings_.process.node.unit) return;
    shedding_.see_voted(identity_of(voted), voted.stamp_ns, node_.clock().steady_ns());
    if (!integrator_) {
        if (!first_voted_ || identity_of(voted) >= identity_of(*first_voted_)) first_voted_ = voted;
        return;
    }
    const auto mending = integrator_->on_voted(voted);
    if (mending.done) events_.report_mending(identity_of(voted), mending, *intake_.description());
}

void IntegratorService::on_command(const FaultCommand& command)
{
    publish_pending();
    resets_.receive(command, integrator_ ? &*integrator_ : nullptr, identity_of(events_.last()));
}

}  // namespace quorient::integrator
