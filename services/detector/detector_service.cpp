#include "detector_service.hpp"

#include "quorient/geometry/sensor_cluster.hpp"
#include "quorient/messages/left_out.hpp"
#include "quorient/messages/meaning.hpp"
#include "quorient/messages/words.hpp"

#include <fmt/format.h>
#include <utility>

namespace quorient::detector {

namespace {

constexpr unsigned most_unmatched_looks = 100;  // 2 s, less than a publisher waits

}  // namespace

DetectorService::DetectorService(const system::DetectorProcess& settings, bus::Bus& bus, runtime::EventLoop& loop)
    : settings_(settings),
      node_(settings.process.node, bus, loop),
      verdicts_(bus.advertise(bus::topics::verdict)),
      shedding_(node_, "verdicts"),
      outlet_(shedding_, loop, [this](const FaultVerdict& verdict) { send(verdict); }),
      diagnosis_(bus, node_, settings.detector),
      intake_(settings.process.node.unit, settings.kind),
      intake_report_(node_),
      events_(node_),
      adoption_(settings.verdict.warm_up_frames)
{
    node_.main_output([this] { return verdicts_.status(); });
    node_.watch(
        bus::topics::verdict.spec.name, [this] { return verdicts_.status(); }, true);
    loop.on(bus.subscribe(bus::topics::cluster), [this](const ClusterDescription& description) {
        intake_.describe(description);
        handle_accepted();
    });
    // An attitude is of use with the next frame, not before.
    loop.on(bus.subscribe(bus::topics::attitude, {settings.attitudes_from, bus::Wake::with_others}), [this](const AttitudeState& attitude) { on_lane_attitude(attitude); });
    loop.on(bus.subscribe(bus::topics::voter_output), [this](const VotedAttitude& voted) { on_voted(voted); });
    node_.on_order({CommandAction::readmit}, [this](const FaultCommand& command) { on_command(command); });
    frames_ = &loop.on(bus.subscribe(bus::topics::frame), [this](const SensorFrame& frame) { on_frame(frame); });
    node_.watch(
        bus::topics::frame.spec.name, [this] { return frames_->status(); }, true);
    node_.ready_when([this] { return has_all_it_needs(); });
}

bool DetectorService::has_all_it_needs()
{
    if (!intake_.described() || frames_->status().matched == 0) return false;
    // Where there are no integrators, a monitor may read the verdicts: it is waited for, but not for ever.
    const bool has_waited = !unit_kind(settings_.kind).gives_attitude && ++unmatched_looks_ > most_unmatched_looks;
    return verdicts_.status().matched > 0 || has_waited;
}

void DetectorService::on_frame(const SensorFrame& frame)
{
    arrival_ns_ = node_.clock().steady_ns();
    if (!intake_.offer(frame, arrival_ns_)) return;
    handle_accepted();
    intake_report_.update(intake_);
}

void DetectorService::handle_accepted()
{
    while (const auto* accepted = intake_.next()) {
        if (accepted->new_description && !prepare(*intake_.description())) return;
        if (monitor_) assess(accepted->frame);
    }
}

/// A new description makes a new detector; what was isolated stays so.
bool DetectorService::prepare(const ClusterDescription& description)
{
    auto made = settings_.make_monitor(description);
    if (!made) {
        node_.report(EventCode::rejected_input, Severity::fatal, {description.epoch, 0}, 0, made.error().why);
        // The publisher may correct its description. A method that does not fit the first sound cluster is a mistake of the system file.
        const bool mendable = monitor_ || made.error().by_description;
        if (!mendable) node_.loop().quit(2);
        monitor_.reset();
        return mendable;
    }
    monitor_ = std::move(*made);
    adopt(isolations_of(events_.last()).in_new_epoch());
    adopt(adoption_.kept(description.epoch));
    return true;
}

void DetectorService::assess(const SensorFrame& frame)
{
    adoption_.on_frame(identity_of(frame));
    FaultVerdict verdict = monitor_->assess(frame);
    verdict.unit = settings_.process.node.unit;
    verdict.kind = frame.kind;
    verdict.detector = settings_.detector;
    verdict.stamp_ns = frame.stamp_ns;
    verdict.stamp_ns[static_cast<std::size_t>(Hop::detector_in)] = node_.settings().stamps ? arrival_ns_ : 0;
    verdict.stamp_ns[static_cast<std::size_t>(Hop::detector_out)] = node_.stamp();
    shedding_.see(identity_of(frame), frame.stamp_ns, frame.interval_s, arrival_ns_);
    outlet_.give(verdict, is_news(verdict));
    node_.handled(identity_of(frame), arrival_ns_);
    node_.set_state(ServiceState::running);
    adoption_.on_verdict(verdict);
    diagnosis_.update(*monitor_, *intake_.description());
    events_.report_changes(verdict, *intake_.description(), monitor_->detector().reason(), diagnosis_.latest());
}

/// What an integrator or a voter acts on differs from the verdict before.
bool DetectorService::is_news(const FaultVerdict& verdict) const
{
    const FaultVerdict& last = events_.last();
    return verdict.epoch != last.epoch || verdict.state != last.state || verdict.isolated_mask != last.isolated_mask ||
           verdict.suspect_mask != last.suspect_mask || verdict.excluded_from != last.excluded_from ||
           verdict.candidate_count != last.candidate_count || verdict.candidate_set != last.candidate_set;
}

void DetectorService::send(const FaultVerdict& verdict)
{
    if (verdicts_.publish(verdict)) ++node_.status().published;
}

void DetectorService::adopt(const Exclusions& exclusions)
{
    if (monitor_ && exclusions.mask() != 0) monitor_->adopt(exclusions);
}

void DetectorService::on_lane_attitude(const AttitudeState& attitude)
{
    if (attitude.unit != settings_.process.node.unit || attitude.lane != settings_.lane) return;
    if (adoption_.on_lane(attitude) && monitor_) adopt(adoption_.kept(intake_.description()->epoch));
}

void DetectorService::on_voted(const VotedAttitude& voted)
{
    if (voted.unit != settings_.process.node.unit) return;
    shedding_.see_voted(identity_of(voted), voted.stamp_ns, node_.clock().steady_ns());
    const bool keeps = adoption_.on_voted(voted);
    if (!monitor_) return;
    adopt(keeps ? adoption_.kept(intake_.description()->epoch) : adoption_.missed(voted, events_.last().isolated_mask));
}

void DetectorService::on_command(const FaultCommand& command)
{
    const auto* description = intake_.description();
    const auto names_of = [&](AxisMask axes) { return description ? axis_names(*description, axes) : axis_numbers(axes); };
    if (const AxisMask still = monitor_ ? monitor_->contradicted(command.axes) : 0; still != 0)
        return answer(command, false, fmt::format("does not readmit what still disagrees with the others: {}", names_of(still)));
    const bool returned = monitor_ && monitor_->readmit(command.axes);
    const bool forgotten = adoption_.on_readmission();
    const char* outcome = returned ? "readmits" : forgotten ? "takes over no exclusion of" : "has not isolated";
    answer(command, returned || forgotten, fmt::format("{} {}", outcome, names_of(command.axes)));
}

void DetectorService::answer(const FaultCommand& command, bool done, const std::string& text)
{
    node_.report(done ? EventCode::command_done : EventCode::command_refused, done ? Severity::info : Severity::warning_low,
                 identity_of(events_.last()), command.axes, text, command.request);
}

}  // namespace quorient::detector
