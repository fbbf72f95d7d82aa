#include "voter_service.hpp"

#include "quorient/messages/name.hpp"
#include "quorient/messages/time.hpp"

#include <algorithm>

namespace quorient::voter {

namespace {

/// The strongest voter of the list owns `voted`.
bus::WriterOptions ownership(const voting::VoterSettings& settings)
{
    return {.strength = static_cast<std::int32_t>(settings.voters.size() + 1 - settings.voter), .lease_s = settings.lease_s};
}

}  // namespace

VoterService::VoterService(const system::VoterProcess& settings, bus::Bus& bus, runtime::EventLoop& loop)
    : settings_(settings),
      node_(settings.process.node, bus, loop),
      outputs_(bus.advertise(bus::topics::voter_output)),
      voted_(bus.advertise(bus::topics::voted, ownership(settings.voting))),
      shedding_(node_, "frames"),
      pace_(settings.voting.lanes.size()),
      poll_timer_(loop.timer([this] {
          brain_.poll(node_.clock().steady_ns());
          drain();
      })),
      brain_(settings.voting)
{
    const auto now = [this] { return arrival_ns_ = node_.clock().steady_ns(); };
    node_.main_output([this] { return outputs_.status(); });
    loop.on(bus.subscribe(bus::topics::voter_output), [this, now](const VotedAttitude& output) {
        brain_.on_other_voter(output, now());
        drain();
    });
    // A verdict counts when the attitudes of its frame come, and is taken before them.
    loop.on(bus.subscribe(bus::topics::verdict, {.wake = bus::Wake::with_others}), [this, now](const FaultVerdict& verdict) {
        brain_.on_verdict(verdict, now());
        drain();
    });
    attitudes_ = &loop.on(bus.subscribe(bus::topics::attitude), [this](const AttitudeState& attitude) { on_attitude(attitude); });
    loop.after_round([this] {
        if (!paced_) return;
        brain_.poll(node_.clock().steady_ns());
        drain();
    });
    node_.watch(
        bus::topics::attitude.spec.name, [this] { return attitudes_->status(); }, true);
    node_.watch(
        bus::topics::voted.spec.name, [this] { return voted_.status(); }, false);
    // `voted` lives by assertion: a voter that hangs, or has nothing to say, loses it within one lease.
    loop.every(nanoseconds(settings.voting.lease_s / 4), [this] {
        if (brain_.may_own()) voted_.assert_liveliness();
    });
    node_.ready_when([this] { return attitudes_->status().matched >= settings_.voting.lanes.size(); });
    if (settings.ros2) ros2_.emplace(*settings.ros2, settings.voting, bus, loop);
    drain();
}

void VoterService::on_attitude(const AttitudeState& attitude)
{
    arrival_ns_ = node_.clock().steady_ns();
    const bool sheds_alone = keep_pace(attitude);
    if (sheds_alone || (paced_ && !runtime::Pace::keeps(identity_of(attitude)))) {
        shedding_.count_skipped();
    } else {
        brain_.on_attitude(attitude, arrival_ns_);
        drain();
    }
    node_.handled(identity_of(attitude), arrival_ns_);
}

/// @returns whether this lane leaves frames out and too few others do
bool VoterService::keep_pace(const AttitudeState& attitude)
{
    const auto& lanes = settings_.voting.lanes;
    const auto lane = std::ranges::find(lanes, attitude.lane, &voting::LaneSettings::lane);
    if (lane == lanes.end() || attitude.unit != settings_.voting.unit || attitude.epoch != brain_.epoch()) return false;
    shedding_.see(identity_of(attitude), attitude.stamp_ns, settings_.voting.interval_s, arrival_ns_);
    const auto place = static_cast<std::size_t>(lane - lanes.begin());
    pace_.see(place, identity_of(attitude), arrival_ns_);
    paced_ = shedding_.active() || pace_.many_shed(arrival_ns_);
    brain_.keep_pace(paced_ ? runtime::Pace::kept_of : 1);
    return !paced_ && pace_.sheds(place);
}

void VoterService::drain()
{
    VotedAttitude owned;
    while (brain_.next_owned(owned, node_.clock().steady_ns())) {
        stamp(owned);
        voted_.publish(owned);
    }
    while (brain_.next_output(output_)) {
        stamp(output_);
        outputs_.publish(output_);
        ++node_.status().published;
        node_.set_state(ServiceState::running);
    }
    voting::VoterEvent event;
    while (brain_.next_event(event)) node_.report(event.code, event.severity, event.identity, event.axes, text_of(event.text));
    copy_counters();
    poll_timer_.set(brain_.next_deadline_ns());
}

void VoterService::stamp(VotedAttitude& output)
{
    output.stamp_ns[static_cast<std::size_t>(Hop::voter_in)] = node_.settings().stamps ? arrival_ns_ : 0;
    output.stamp_ns[static_cast<std::size_t>(Hop::voter_out)] = node_.stamp();
}

void VoterService::copy_counters()
{
    const auto& counters = brain_.counters();
    auto& status = node_.status();
    status.gaps = counters.gaps;
    status.duplicates = counters.duplicates;
    status.late = counters.late;
    status.foreign = counters.foreign;
    status.rejected = counters.rejected;
}

}  // namespace quorient::voter
