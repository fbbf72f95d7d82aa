#include "quorient/fdi/fault_monitor.hpp"

#include "quorient/fdi/methods.hpp"
#include "quorient/messages/exclusions.hpp"
#include "quorient/messages/meaning.hpp"

#include "observers/observer_readmission.hpp"
#include "verdict/axis_health.hpp"
#include "verdict/readmission.hpp"
#include "verdict/verdict_machine.hpp"

#include <bit>
#include <optional>
#include <utility>

namespace quorient::fdi {

struct FaultMonitor::Watch {
    explicit Watch(const VerdictMachine& its_machine) : machine(its_machine) {}

    VerdictMachine machine;
    std::optional<AxisHealth> health;                          ///< of axes that are directions in space
    std::optional<Readmission> readmission;                    ///< of such axes, where axes may return by themselves
    std::optional<ObserverReadmission> observer_readmission;  ///< of other channels, likewise
};

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
    FaultMonitor monitor(std::move(detector), std::make_unique<Watch>(*machine), cluster.all());
    monitor.watch_->health.emplace(cluster);
    if (verdict.readmit_after_s) monitor.watch_->readmission.emplace(cluster, *verdict.readmit_after_s);
    return monitor;
}

tl::expected<FaultMonitor, std::string> FaultMonitor::make(std::unique_ptr<Detector> detector, const VerdictSettings& verdict,
                                                           std::size_t channels)
{
    const auto machine = VerdictMachine::make(verdict, channels, 1);
    if (!machine) return tl::unexpected(machine.error());
    FaultMonitor monitor(std::move(detector), std::make_unique<Watch>(*machine), all_axes(channels));
    if (verdict.readmit_after_s) monitor.watch_->observer_readmission.emplace(*verdict.readmit_after_s);
    return monitor;
}

FaultMonitor::FaultMonitor(std::unique_ptr<Detector> detector, std::unique_ptr<Watch> watch, AxisMask all)
    : detector_(std::move(detector)), watch_(std::move(watch)), all_(all)
{
}

FaultMonitor::FaultMonitor(FaultMonitor&&) noexcept = default;
FaultMonitor& FaultMonitor::operator=(FaultMonitor&&) noexcept = default;
FaultMonitor::~FaultMonitor() = default;

const FaultVerdict& FaultMonitor::assess(const SensorFrame& frame)
{
    if (started_ && identity_of(frame) <= identity_of(verdict_)) return verdict_;
    if (started_ && frame.epoch != verdict_.epoch) {
        detector_->reset();
        if (watch_->health) watch_->health->reset();
    }
    started_ = true;

    if (const AxisMask returning = std::exchange(returning_, 0); returning != 0) readmit(returning);
    const Measurement measurement = measurement_of(frame);
    if (watch_->readmission) readmit(watch_->readmission->watch(measurement, watch_->machine.isolated(), all_ & ~watch_->machine.isolated()));
    const AxisMask broken = watch_->health ? watch_->health->assess(measurement) : 0;
    Measurement sound = measurement;
    sound.valid &= ~broken;
    detector_->assess(sound, assessment_);

    const AxisMask before = watch_->machine.isolated();
    verdict_ = watch_->machine.update(measurement.identity, assessment_, broken);
    const AxisMask newly = watch_->machine.isolated() & ~before;
    if (watch_->readmission && newly != 0) watch_->readmission->excluded(newly, measurement, all_ & ~watch_->machine.isolated());
    after_change(before);
    if (watch_->observer_readmission) {
        const bool healthy = state_of(verdict_) == VerdictState::healthy;
        returning_ = watch_->observer_readmission->watch(*detector_, frame.interval_s, watch_->machine.isolated(), newly, healthy);
    }

    verdict_.sample_time_ns = frame.sample_time_ns;
    verdict_.unit = frame.unit;
    verdict_.kind = frame.kind;
    verdict_.detectable_remaining = static_cast<std::uint8_t>(detector_->detectable_remaining());
    return verdict_;
}

void FaultMonitor::adopt(const Exclusions& excluded_from)
{
    const AxisMask before = watch_->machine.isolated();
    watch_->machine.adopt(excluded_from);
    after_change(before);
}

AxisMask FaultMonitor::contradicted(AxisMask axes) const
{
    AxisMask found = 0;
    for (std::size_t axis = 0; axis < max_axes; ++axis) {
        if (!has_axis(axes & watch_->machine.isolated(), axis)) continue;
        const auto expectation = detector_->expectation(axis);
        if (expectation && !expectation->agrees) found |= axis_bit(axis);
    }
    return found;
}

bool FaultMonitor::readmit(AxisMask axes)
{
    const AxisMask before = watch_->machine.isolated();
    const bool returned = watch_->machine.readmit(axes) != 0;
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
    if (watch_->machine.isolated() != before) detector_->exclude(watch_->machine.isolated());
}

}  // namespace quorient::fdi
