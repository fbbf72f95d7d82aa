#include "offline.hpp"

#include <algorithm>

namespace quorient::replay {

namespace {

/// Live epochs come from the wall clock; a replay's is the same on every run.
constexpr std::uint64_t replay_epoch = 1;

void make_offline(system::ProcessSettings& process)
{
    process.node.heartbeat = false;
    process.node.log_events = false;
    process.bus.vendor = Vendor::local;
}

system::System offline(system::System system)
{
    make_offline(system.sensor.process);
    system.sensor.source.speed = 1;
    for (auto& lane : system.lanes) {
        make_offline(lane.detector.process);
        make_offline(lane.integrator.process);
    }
    for (auto& voter : system.voters) make_offline(voter.process);
    return system;
}

}  // namespace

Offline::Offline(system::System system, evaluation::RunObserver& observer, report::ReplayReport& report, const recording::LogOptions& log,
                 report::RunTimeline* timeline)
    : system_(offline(std::move(system))), log_(log), bus_(hub_.open()), loop_(*bus_, clock_, never_stop_)
{
    observe(observer, report);
    if (timeline) draw(*timeline);
    for (const auto& voter : system_.voters) voters_.push_back(std::make_unique<voter::VoterService>(voter, *bus_, loop_));
    for (const auto* integrator : system_.integrators())
        integrators_.push_back(std::make_unique<integrator::IntegratorService>(*integrator, *bus_, loop_));
    for (const auto& lane : system_.lanes) detectors_.push_back(std::make_unique<detector::DetectorService>(lane.detector, *bus_, loop_));
}

void Offline::observe(evaluation::RunObserver& observer, report::ReplayReport& report)
{
    loop_.on(bus_->subscribe(bus::topics::cluster), [&](const ClusterDescription& message) {
        observer.on_description(message);
        report.on_description(message);
    });
    loop_.on(bus_->subscribe(bus::topics::truth), [&](const TruthState& message) { observer.on_truth(message); });
    loop_.on(bus_->subscribe(bus::topics::verdict), [&](const FaultVerdict& message) {
        observer.on_verdict(message);
        report.on_verdict(message);
    });
    loop_.on(bus_->subscribe(bus::topics::diagnosis), [&](const FaultDiagnosis& message) { report.on_diagnosis(message); });
    loop_.on(bus_->subscribe(bus::topics::attitude), [&](const AttitudeState& message) { observer.on_attitude(message); });
    loop_.on(bus_->subscribe(bus::topics::voter_output), [&](const VotedAttitude& message) {
        observer.on_voted(message);
        report.on_voted(message);
    });
    loop_.on(bus_->subscribe(bus::topics::status), [this](const ServiceStatus& message) {
        if (!system_.lanes.empty() && message.service == system_.lanes.front().detector.process.node.service) intake_ = message;
    });
}

void Offline::draw(report::RunTimeline& timeline)
{
    loop_.on(bus_->subscribe(bus::topics::truth), [&](const TruthState& message) { timeline.on_truth(message); });
    loop_.on(bus_->subscribe(bus::topics::verdict), [&](const FaultVerdict& message) { timeline.on_verdict(message); });
    loop_.on(bus_->subscribe(bus::topics::voter_output), [&](const VotedAttitude& message) { timeline.on_voted(message); });
}

tl::expected<void, std::string> Offline::run()
{
    auto source = sensor::make_source(system_.sensor, replay_epoch, log_);
    if (!source) return tl::make_unexpected(source.error());
    sensor::SensorPublisher publisher{system_.sensor, std::move(*source), *bus_, loop_};
    while (!loop_.quit_requested()) {
        while (loop_.dispatch() || loop_.work()) continue;
        clock_.set(std::max(clock_.steady_ns() + 1, loop_.next_deadline_ns()));
    }
    remarks_ = publisher.remarks();
    return {};
}

}  // namespace quorient::replay
