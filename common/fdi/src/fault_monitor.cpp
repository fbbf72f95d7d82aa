#include "quorient/fdi/fault_monitor.hpp"

#include "quorient/fdi/make_detector.hpp"
#include "quorient/messages/exclusions.hpp"
#include "quorient/messages/meaning.hpp"

#include <bit>
#include <utility>

namespace quorient::fdi {

tl::expected<FaultMonitor, std::string> FaultMonitor::make(const DetectorSettings& detector, const VerdictSettings& verdict,
                                                           const geometry::SensorCluster& cluster)
{
    auto method = make_detector(detector, cluster);
    if (!method) return tl::unexpected(method.error());
    return make(std::move(*method), verdict, cluster);
}

tl::expected<FaultMonitor, std::string> FaultMonitor::make(std::unique_ptr<Detector> detector, const VerdictSettings& verdict,
                                                           const geometry::SensorCluster& cluster)
{
    const auto machine = VerdictMachine::make(verdict, cluster.size());
    if (!machine) return tl::unexpected(machine.error());
    FaultMonitor monitor(std::move(detector), *machine, cluster.all());
    monitor.health_.emplace(cluster);
    if (verdict.readmit_after_s) monitor.readmission_.emplace(cluster, *verdict.readmit_after_s);
    return monitor;
}

tl::expected<FaultMonitor, std::string> FaultMonitor::make(std::unique_ptr<Detector> detector, const VerdictSettings& verdict,
                                                           std::size_t channels)
{
    const auto machine = VerdictMachine::make(verdict, channels, 1);
    if (!machine) return tl::unexpected(machine.error());
    FaultMonitor monitor(std::move(detector), *machine, all_axes(channels));
    if (verdict.readmit_after_s) monitor.observer_readmission_.emplace(*verdict.readmit_after_s);
    return monitor;
}

FaultMonitor::FaultMonitor(std::unique_ptr<Detector> detector, const VerdictMachine& machine, AxisMask all)
    : detector_(std::move(detector)), machine_(machine), all_(all)
{
}

const FaultVerdict& FaultMonitor::assess(const SensorFrame& frame)
{
    if (started_ && identity_of(frame) <= identity_of(verdict_)) return verdict_;
    if (started_ && frame.epoch != verdict_.epoch) {
        detector_->reset();
        if (health_) health_->reset();
    }
    started_ = true;

    if (const AxisMask returning = std::exchange(returning_, 0); returning != 0) readmit(returning);
    const Measurement measurement = measurement_of(frame);
    if (readmission_) readmit(readmission_->watch(measurement, machine_.isolated(), all_ & ~machine_.isolated()));
    const AxisMask broken = health_ ? health_->assess(measurement) : 0;
    Measurement sound = measurement;
    sound.valid &= ~broken;
    detector_->assess(sound, assessment_);

    const AxisMask before = machine_.isolated();
    verdict_ = machine_.update(measurement.identity, assessment_, broken);
    const AxisMask newly = machine_.isolated() & ~before;
    if (readmission_ && newly != 0) readmission_->excluded(newly, measurement, all_ & ~machine_.isolated());
    after_change(before);
    if (observer_readmission_) {
        const bool healthy = state_of(verdict_) == VerdictState::healthy;
        returning_ = observer_readmission_->watch(*detector_, frame.interval_s, machine_.isolated(), newly, healthy);
    }

    verdict_.sample_time_ns = frame.sample_time_ns;
    verdict_.unit = frame.unit;
    verdict_.kind = frame.kind;
    verdict_.detectable_remaining = static_cast<std::uint8_t>(detector_->detectable_remaining());
    return verdict_;
}

void FaultMonitor::adopt(const Exclusions& excluded_from)
{
    const AxisMask before = machine_.isolated();
    machine_.adopt(excluded_from);
    after_change(before);
}

AxisMask FaultMonitor::contradicted(AxisMask axes) const
{
    AxisMask found = 0;
    for (std::size_t axis = 0; axis < max_axes; ++axis) {
        if (!has_axis(axes & machine_.isolated(), axis)) continue;
        const auto expectation = detector_->expectation(axis);
        if (expectation && !expectation->agrees) found |= axis_bit(axis);
    }
    return found;
}

bool FaultMonitor::readmit(AxisMask axes)
{
    const AxisMask before = machine_.isolated();
    const bool returned = machine_.readmit(axes) != 0;
    after_change(before);
    return returned;
}

Measurement FaultMonitor::measurement_of(const SensorFrame& frame) const
{
    const auto axes = static_cast<std::size_t>(std::popcount(all_));
    return {.identity = identity_of(frame),
            .interval_s = frame.interval_s,
            .increment = std::span(frame.increment).first(axes),
            .valid = frame.valid_mask & all_,
            .known_input = frame.known_input};
}

void FaultMonitor::after_change(AxisMask before)
{
    if (machine_.isolated() != before) detector_->exclude(machine_.isolated());
}

}  // namespace quorient::fdi
