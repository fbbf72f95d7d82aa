#include "detector_service.hpp"

#include "quorient/fdi/observer_detector.hpp"
#include "quorient/geometry/sensor_cluster.hpp"
#include "quorient/messages/exclusions.hpp"
#include "quorient/messages/meaning.hpp"
#include "quorient/runtime/intake_report.hpp"
#include "quorient/messages/words.hpp"

#include <fmt/format.h>
#include <algorithm>
#include <functional>
#include <iterator>
#include <numeric>
#include <utility>

namespace quorient::detector {

namespace {

AxisMask all_candidates(const FaultVerdict& verdict)
{
    const auto end = verdict.candidate_set.begin() + std::min<std::ptrdiff_t>(verdict.candidate_count, std::ssize(verdict.candidate_set));
    return std::accumulate(verdict.candidate_set.begin(), end, AxisMask{0}, std::bit_or<>{});
}

constexpr std::int64_t readiness_period_ns = 20'000'000;
constexpr unsigned most_unheard_looks = 100;  // 2 s, less than a publisher waits

}  // namespace

DetectorService::DetectorService(const system::DetectorProcess& settings, bus::Bus& bus, runtime::EventLoop& loop)
    : settings_(settings),
      node_(settings.process.node, bus, loop),
      verdicts_(bus.advertise(bus::topics::verdict)),
      intake_(settings.process.node.unit, settings.kind)
{
    node_.main_output([this] { return verdicts_.status(); });
    node_.watch(
        bus::topics::verdict.spec.name, [this] { return verdicts_.status(); }, true);
    loop.on(bus.subscribe(bus::topics::cluster), [this](const ClusterDescription& description) {
        intake_.describe(description);
        handle_accepted();
    });
    loop.on(bus.subscribe(bus::topics::attitude), [this](const AttitudeState& attitude) { on_lane_attitude(attitude); });
    loop.on(bus.subscribe(bus::topics::voter_output), [this](const VotedAttitude& voted) { on_voted(voted); });
    node_.on_order([this](const FaultCommand& command) { on_command(command); });
    frames_ = &loop.on(bus.subscribe(bus::topics::frame), [this](const SensorFrame& frame) { on_frame(frame); });
    node_.watch(
        bus::topics::frame.spec.name, [this] { return frames_->status(); }, true);
    loop.until(readiness_period_ns, [this] { return look_at_readiness(); });
}

bool DetectorService::look_at_readiness()
{
    if (node_.state() != ServiceState::starting) return true;
    if (!intake_.described() || frames_->status().matched == 0) return false;
    // A vessel has no integrator that surely reads its verdicts; a monitor that does is waited for.
    const bool has_waited = settings_.observers && ++unheard_looks_ > most_unheard_looks;
    if (verdicts_.status().matched == 0 && !has_waited) return false;
    node_.set_state(ServiceState::ready);
    return true;
}

void DetectorService::on_frame(const SensorFrame& frame)
{
    arrival_ns_ = node_.clock().steady_ns();
    if (!intake_.offer(frame, arrival_ns_)) return;
    handle_accepted();
    runtime::report_intake(intake_, node_, told_rejected_, told_foreign_);
}

void DetectorService::handle_accepted()
{
    while (const auto* accepted = intake_.next()) {
        if (accepted->new_description && !prepare(*intake_.description())) return;
        if (monitor_) assess(accepted->frame);
    }
}

tl::expected<fdi::FaultMonitor, std::string> DetectorService::make_method(const ClusterDescription& description) const
{
    const auto cluster = geometry::make_cluster(description);
    if (!cluster) return tl::make_unexpected(cluster.error());
    return fdi::FaultMonitor::make(settings_.detection, settings_.verdict, *cluster);
}

tl::expected<fdi::FaultMonitor, std::string> DetectorService::make_observers(const ClusterDescription& description) const
{
    const auto channels = static_cast<std::size_t>(settings_.observers->plant.outputs());
    if (description.axis_count != channels)
        return tl::make_unexpected(
            fmt::format("the description has {} channels, the plant of the system file {}", description.axis_count, channels));
    auto observers = fdi::ObserverDetector::make(*settings_.observers, description.interval_s, settings_.observer_margin);
    if (!observers) return tl::make_unexpected(observers.error());
    return fdi::FaultMonitor::make(std::move(*observers), settings_.verdict, channels);
}

/// A new description makes a new detector; what was isolated stays so.
bool DetectorService::prepare(const ClusterDescription& description)
{
    auto made = settings_.observers ? make_observers(description) : make_method(description);
    if (!made) {
        node_.report(EventCode::rejected_input, Severity::fatal, {description.epoch, 0}, 0, made.error());
        // Whoever publishes this may mend it; a method that does not fit the first sound cluster is the system file's mistake.
        const bool mendable = monitor_ || (!settings_.observers && !geometry::make_cluster(description));
        if (!mendable) node_.loop().quit(2);
        monitor_.reset();
        return mendable;
    }
    monitor_ = std::move(*made);
    if (last_.isolated_mask != 0) {
        // Sequences start again with the epoch: what was bad before is bad from its first frame.
        monitor_->adopt(last_.excluded_from.of(last_.isolated_mask).in_new_epoch());
    }
    adopt_memories();
    return true;
}

void DetectorService::assess(const SensorFrame& frame)
{
    if (frame.epoch != last_.epoch) absence_ = {0, frame.sequence};
    else if (frame.sequence > last_.sequence + 1) absence_ = {last_.sequence + 1, frame.sequence};
    FaultVerdict verdict = monitor_->assess(frame);
    verdict.unit = settings_.process.node.unit;
    verdict.kind = frame.kind;
    verdict.detector = settings_.detector;
    verdict.stamp_ns = frame.stamp_ns;
    verdict.stamp_ns[static_cast<std::size_t>(Hop::detector_in)] = node_.settings().stamps ? arrival_ns_ : 0;
    verdict.stamp_ns[static_cast<std::size_t>(Hop::detector_out)] = node_.stamp();
    if (verdicts_.publish(verdict)) ++node_.status().published;
    node_.handled(identity_of(frame), arrival_ns_);
    node_.set_state(ServiceState::running);
    if (state_of(verdict) != VerdictState::warming_up) adopting_ = false;
    tell_changes(verdict);
    last_ = verdict;
}

std::string DetectorService::describe(AxisMask axes) const
{
    return intake_.description() ? axis_names(*intake_.description(), axes) : axis_numbers(axes);
}

void DetectorService::tell_changes(const FaultVerdict& verdict)
{
    const auto identity = identity_of(verdict);
    const auto newly_isolated = verdict.isolated_mask & ~last_.isolated_mask;
    if (newly_isolated != 0) {
        const std::uint64_t onset = verdict.excluded_from.earliest(newly_isolated);
        node_.report(verdict.adopted ? EventCode::adopted : EventCode::isolated, Severity::warning_high, identity, newly_isolated,
                     fmt::format("{} {} since frame {}: statistic {:.4g}, limit {:.4g}", verdict.adopted ? "ADOPTED" : "ISOLATED",
                                 describe(newly_isolated), onset, verdict.statistic, verdict.threshold));
        if (verdict.detectable_remaining == 0)
            node_.report(EventCode::redundancy_exhausted, Severity::warning_high, identity, verdict.working_mask,
                         "redundancy is used up: a further fault cannot be told");
    }
    const auto readmitted = last_.isolated_mask & ~verdict.isolated_mask;
    if (readmitted != 0)
        node_.report(EventCode::readmitted, Severity::info, identity, readmitted, fmt::format("READMITTED {}", describe(readmitted)));
    if (verdict.state == last_.state || newly_isolated != 0) return;
    const auto reason = monitor_->detector().reason();
    switch (state_of(verdict)) {
        case VerdictState::ambiguous:
            node_.report_throttled(EventCode::ambiguous, Severity::warning_high, identity, verdict.suspect_mask,
                                   fmt::format("AMBIGUOUS: {} candidate sets, one of {} is faulty", verdict.candidate_count,
                                               describe(all_candidates(verdict))));
            break;
        case VerdictState::blind:
            node_.report_throttled(EventCode::blind, Severity::warning_high, identity, 0,
                                   fmt::format("BLIND: {}", reason.empty() ? "no set of faults within reach explains the data" : reason));
            break;
        case VerdictState::suspect:
            node_.report_throttled(EventCode::suspect, Severity::warning_low, identity, verdict.suspect_mask,
                                   !reason.empty() ? fmt::format("SUSPECT: {}", reason)
                                                   : fmt::format("SUSPECT {}: statistic {:.4g}, limit {:.4g}",
                                                                 describe(verdict.suspect_mask), verdict.statistic, verdict.threshold));
            break;
        case VerdictState::warming_up:
            if (!reason.empty())
                node_.report_throttled(EventCode::blind, Severity::info, identity, 0, fmt::format("WARMING_UP: {}", reason));
            break;
        default:
            break;
    }
}

/// After a restart the lane remembers what this detector had found.
void DetectorService::on_lane_attitude(const AttitudeState& attitude)
{
    if (attitude.unit != settings_.process.node.unit || attitude.lane != settings_.lane || attitude.isolated_mask == 0) return;
    remember(attitude.epoch, attitude.excluded_from.of(attitude.isolated_mask), of_lane_);
}

/// A fault that was isolated while this detector was dead may show no more; what a majority of lanes stands behind is taken over.
void DetectorService::on_voted(const VotedAttitude& voted)
{
    if (voted.unit != settings_.process.node.unit || voted.isolated_mask == 0 || !is_vouched(voted)) return;
    if (adopting_) remember(voted.epoch, voted.excluded_from.of(voted.isolated_mask), of_voters_);
    else if (monitor_ && voted.epoch == last_.epoch) adopt_missed(voted);
}

/// A fault that began while this detector was cut off, or before it started, has no onset here: four axes alone cannot name it any more.
/// What a majority of lanes stands behind is taken over for such an axis, and for no other.
void DetectorService::adopt_missed(const VotedAttitude& voted)
{
    const std::uint64_t warm_up = settings_.verdict.warm_up_frames;  // an onset so close to the gap was not seen either
    Exclusions missed;
    for (std::size_t axis = 0; axis < max_axes; ++axis) {
        const std::uint64_t onset = voted.excluded_from[axis];
        const bool unseen = onset != never && absence_.end != 0 && onset + warm_up >= absence_.first && onset < absence_.end + warm_up;
        if (!unseen || !has_axis(voted.isolated_mask & ~last_.isolated_mask, axis)) continue;
        missed[axis] = onset;
    }
    if (missed.mask() != 0) monitor_->adopt(missed);
}

void DetectorService::remember(std::uint64_t epoch, const Exclusions& excluded_from, Memory& memory)
{
    memory = {epoch, excluded_from, true};
    if (monitor_) adopt_memories();
}

void DetectorService::adopt_memories()
{
    if (!adopting_) return;
    for (const Memory* memory : {&of_lane_, &of_voters_}) {
        if (!memory->known) continue;
        const bool same_epoch = memory->epoch == intake_.description()->epoch;
        monitor_->adopt(same_epoch ? memory->excluded_from : memory->excluded_from.in_new_epoch());
    }
}

void DetectorService::on_command(const FaultCommand& command)
{
    if (action_of(command) != CommandAction::readmit) return;
    if (const AxisMask still = monitor_ ? monitor_->contradicted(command.axes) : 0; still != 0)
        return answer(command, false, fmt::format("does not readmit what still disagrees with the others: {}", describe(still)));
    const bool returned = monitor_ && monitor_->readmit(command.axes);
    const bool forgotten = std::exchange(adopting_, false);  // what others remember is older than this order
    absence_ = {};
    const char* outcome = returned ? "readmits" : forgotten ? "takes over no exclusion of" : "has not isolated";
    answer(command, returned || forgotten, fmt::format("{} {}", outcome, describe(command.axes)));
}

void DetectorService::answer(const FaultCommand& command, bool done, const std::string& text)
{
    node_.report(done ? EventCode::command_done : EventCode::command_refused, done ? Severity::info : Severity::warning_low,
                 identity_of(last_), command.axes, text, command.request);
}

}  // namespace quorient::detector
