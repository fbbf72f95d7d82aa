#include "integrator_service.hpp"

#include "quorient/geometry/sensor_cluster.hpp"
#include "quorient/messages/meaning.hpp"
#include "quorient/messages/words.hpp"
#include "quorient/rotation/quaternion.hpp"
#include "quorient/runtime/intake_report.hpp"
#include "quorient/messages/words.hpp"

#include <fmt/format.h>
#include <bit>
#include <cmath>
#include <numbers>
#include <utility>

namespace quorient::integrator {

namespace {

constexpr std::int64_t readiness_period_ns = 20'000'000;

/// Frames that an integrator may miss before it asks whether the other lanes know better what turned meanwhile.
constexpr std::uint64_t longest_own_absence = 5;

/// They do when their standard deviation is so many times smaller; where everybody was cut off, all are alike.
constexpr double much_surer = 4;

/// An order about a frame that other lanes have had already waits for it; one further off is a mistake.
constexpr double most_frames_ahead = 64;

/// So long it waits before it is refused.
constexpr std::int64_t reset_patience_ns = 1'000'000'000;

/// Of an axis' direction between descriptions of the same sensors: more than rounding, less than any mounting.
constexpr double largest_axis_change = 1e-6;

}  // namespace

IntegratorService::IntegratorService(const system::IntegratorProcess& settings, bus::Bus& bus, runtime::EventLoop& loop)
    : settings_(settings),
      node_(settings.process.node, bus, loop),
      attitudes_(bus.advertise(bus::topics::attitude)),
      patience_timer_(loop.timer([this] { publish_pending(); })),
      reset_timer_(loop.timer([this] { refuse_waiting_reset("has not come within a second"); })),
      intake_(settings.process.node.unit, settings.kind)
{
    node_.main_output([this] { return attitudes_.status(); });
    node_.watch(
        bus::topics::attitude.spec.name, [this] { return attitudes_.status(); }, true);
    loop.on(bus.subscribe(bus::topics::cluster), [this](const ClusterDescription& description) { on_description(description); });
    loop.on(bus.subscribe(bus::topics::voter_output), [this](const VotedAttitude& voted) { on_voted(voted); });
    node_.on_order([this](const FaultCommand& command) { on_command(command); });
    verdicts_ = &loop.on(bus.subscribe(bus::topics::verdict), [this](const FaultVerdict& verdict) { on_verdict(verdict); });
    frames_ = &loop.on(bus.subscribe(bus::topics::frame), [this](const SensorFrame& frame) { on_frame(frame); });
    node_.watch(
        bus::topics::frame.spec.name, [this] { return frames_->status(); }, true);
    node_.watch(
        bus::topics::verdict.spec.name, [this] { return verdicts_->status(); }, true);
    loop.until(readiness_period_ns, [this] { return look_at_readiness(); });
    loop.when_idle([this] { return integrator_ && integrator_->work(); });
}

bool IntegratorService::look_at_readiness()
{
    if (node_.state() != ServiceState::starting) return true;
    if (!intake_.described() || frames_->status().matched == 0 || verdicts_->status().matched == 0 || attitudes_.status().matched == 0)
        return false;
    node_.set_state(ServiceState::ready);
    return true;
}

/// Of an epoch to come only an attitude measured at its start counts: what the configuration states was true once.
void IntegratorService::on_description(const ClusterDescription& description)
{
    intake_.describe(description);
    const bool measured = initial_attitude_of(description) == InitialAttitude::measured;
    if (integrator_ && measured && description.unit == settings_.process.node.unit && description.epoch > last_.epoch)
        integrator_->begin_epoch(description.epoch, description.initial_attitude);
    handle_accepted();
}

void IntegratorService::on_frame(const SensorFrame& frame)
{
    arrival_ns_ = node_.clock().steady_ns();
    if (!intake_.offer(frame, arrival_ns_)) return;
    handle_accepted();
    runtime::report_intake(intake_, node_, told_rejected_, told_foreign_);
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

/// The configured attitude is that at the start of sequence 0, and true only for who was there: who comes later, or after another epoch,
/// takes over what the voters stand for.
bool IntegratorService::prepare(const ClusterDescription& description, std::uint64_t first_sequence)
{
    auto integration = settings_.integration;
    integration.initialised = first_sequence == 0 && !voted_;
    if (initial_attitude_of(description) != InitialAttitude::unknown)
        integration.initial_attitude = description.initial_attitude;
    auto cluster = geometry::make_cluster(description);
    if (!cluster) {
        // Whoever publishes this may mend it; a settings file that fits no cluster is this process's own end.
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
    if (!integration.initialised && voted_) integrator_->seed(*voted_);
    if (verdict_) integrator_->apply(*verdict_);
    return true;
}

std::string IntegratorService::names_of(AxisMask axes) const
{
    return intake_.description() ? axis_names(*intake_.description(), axes) : axis_numbers(axes);
}

/// The history is one of these axes; a publisher that comes back with others needs lanes that start anew.
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
    if (last_.epoch == frame.epoch && frame.sequence > last_.sequence + longest_own_absence) absent_until_ = identity_of(frame);
    integrator_->add(frame);
    pending_ = identity_of(frame);
    stamps_ = frame.stamp_ns;
    stamps_[static_cast<std::size_t>(Hop::integrator_in)] = node_.settings().stamps ? arrival_ns_ : 0;
    node_.set_state(ServiceState::running);
    if (verdict_ && identity_of(*verdict_) >= *pending_) publish_pending();
    else patience_timer_.set(arrival_ns_ + static_cast<std::int64_t>(settings_.patience * frame.interval_s * 1e9));
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
        // What it waited for came last: from here on it works.
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
    if (attitudes_.publish(attitude)) ++node_.status().published;
    node_.handled(identity_of(attitude), arrival_ns_);
    tell_changes(attitude);
    last_ = attitude;
    if (waiting_reset_ && static_cast<double>(last_.sequence) >= waiting_reset_->value) obey(*std::exchange(waiting_reset_, {}));
}

void IntegratorService::tell_changes(const AttitudeState& attitude)
{
    const auto identity = identity_of(attitude);
    if (attitude.rolled_back_frames > 0)
        node_.report(EventCode::rolled_back, Severity::info, identity, attitude.isolated_mask,
                     fmt::format("attitude corrected by {:.3g} deg: {} frames integrated again without {}; {} axes in use",
                                 rotation::angle_of(attitude.reset_rotation) * 180 / std::numbers::pi, attitude.rolled_back_frames,
                                 names_of(attitude.isolated_mask), std::popcount(attitude.used_mask)));
    if (integrator_->history_too_short() > told_too_short_) {
        told_too_short_ = integrator_->history_too_short();
        node_.report(EventCode::history_too_short, Severity::warning_high, identity, attitude.isolated_mask,
                     "a verdict reaches further back than the history: corrected as far as it goes");
    }
    if (attitude.bridged && !last_.bridged)
        node_.report_throttled(EventCode::gap_bridged, Severity::warning_low, identity, 0,
                               "frames are missing: bridged by the accumulated angles");
    if (attitude.seeded && !last_.seeded)
        node_.report(EventCode::seeded, Severity::info, identity, 0, "SEEDED: took over the voted attitude");
    if (mode_of(attitude) == AttitudeMode::coasting && mode_of(last_) != AttitudeMode::coasting)
        node_.report_throttled(EventCode::coasting, Severity::warning_high, identity, attitude.used_mask,
                               "COASTING: fewer than three trusted axes, the attitude is held");
    if (mode_of(attitude) == AttitudeMode::lost && mode_of(last_) != AttitudeMode::lost)
        node_.report_throttled(EventCode::lost, Severity::warning_high, identity, 0,
                               "LOST: the rotation in between is not known; re-align with a reset of the attitude");
}

void IntegratorService::on_voted(const VotedAttitude& voted)
{
    if (voted.unit != settings_.process.node.unit || (voted_ && identity_of(voted) < identity_of(*voted_))) return;
    voted_ = voted;
    if (!integrator_) return;
    const bool vouched = is_vouched(voted);
    if (vouched && voted.primary_lane != settings_.integration.lane) integrator_->let_go(~voted.isolated_mask);
    if (mode_of(integrator_->state()) == AttitudeMode::initialising) return integrator_->seed(voted);
    if (vouched) mend_seed(voted);
    if (absent_until_ && identity_of(voted) >= *absent_until_) rejoin(voted);
}

/// @returns why not; empty if done.
std::string IntegratorService::reset_attitude(const FaultCommand& command)
{
    double norm = 0;
    for (const double component : command.attitude) norm += component * component;
    if (!(std::abs(norm - 1) < 1e-6)) return "cannot reset: not a unit quaternion";
    if (!integrator_) return "cannot reset: no frame yet";
    constexpr double exact_in_a_double = 9e15;
    const bool sequence = command.value >= 0 && command.value < exact_in_a_double;
    if (!sequence || !integrator_->reset(command.attitude, static_cast<std::uint64_t>(command.value)))
        return fmt::format("cannot reset: sequence {:.0f} is not in the history", command.value);
    return {};
}

/// What was taken over between the beginning of a fault and its isolation has the fault in it. The lanes that were there before have
/// corrected themselves since.
void IntegratorService::mend_seed(const VotedAttitude& voted)
{
    const auto axes = integrator_->distrusted_in_seed();
    const bool corrected = (axes & ~voted.isolated_mask) == 0 && voted.primary_lane != settings_.integration.lane;
    if (axes == 0 || !corrected) return;
    integrator_->seed(voted);
    if (integrator_->distrusted_in_seed() != 0) return;  // that frame has not come yet
    node_.report(EventCode::seeded, Severity::info, identity_of(voted), axes,
                 fmt::format("SEEDED again: the attitude taken over had a fault of {} in it", names_of(axes)));
}

/// This process was stopped or cut off: the bridge over its absence lacks the coning in it, the lanes that went on do not.
void IntegratorService::rejoin(const VotedAttitude& voted)
{
    if (!is_vouched(voted) && level_of(voted) != VoteLevel::single) return;
    const bool surer = voted.angle_sigma_rad * much_surer < integrator_->state().angle_sigma_rad;
    if (surer && voted.primary_lane != settings_.integration.lane) integrator_->seed(voted);
    absent_until_.reset();
}

void IntegratorService::on_command(const FaultCommand& command)
{
    if (action_of(command) != CommandAction::reset_attitude) return;
    publish_pending();
    refuse_waiting_reset("had not come when another order did");
    const double frames_ahead = command.value - static_cast<double>(last_.sequence);
    if (integrator_ && frames_ahead > 0 && frames_ahead < most_frames_ahead) {
        waiting_reset_ = command;
        reset_timer_.set(node_.clock().steady_ns() + reset_patience_ns);
        return;
    }
    obey(command);
}

void IntegratorService::obey(const FaultCommand& command)
{
    const auto refusal = reset_attitude(command);
    if (!refusal.empty()) return refuse(command, refusal);
    node_.report(EventCode::command_done, Severity::info, identity_of(last_), 0,
                 fmt::format("attitude reset by command as of sequence {:.0f}", command.value), command.request);
}

void IntegratorService::refuse(const FaultCommand& command, const std::string& why)
{
    node_.report(EventCode::command_refused, Severity::warning_low, identity_of(last_), 0, why, command.request);
}

void IntegratorService::refuse_waiting_reset(const char* what_became_of_its_frame)
{
    const auto command = std::exchange(waiting_reset_, {});
    if (command) refuse(*command, fmt::format("cannot reset: sequence {:.0f} {}", command->value, what_became_of_its_frame));
}

}  // namespace quorient::integrator
