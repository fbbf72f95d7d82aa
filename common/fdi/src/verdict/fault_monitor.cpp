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

namespace {

/// What an axis's own values prove, in the words of the wire.
Diagnosis diagnosis_of(AxisFault fault)
{
    switch (fault) {
        case AxisFault::stuck: return Diagnosis::stuck;
        case AxisFault::zero: return Diagnosis::zero;
        case AxisFault::rail: return Diagnosis::saturated;
        case AxisFault::out_of_range: return Diagnosis::outside_class;
        case AxisFault::none: break;
    }
    return Diagnosis::none;
}

}  // namespace

struct FaultMonitor::Watch {
    explicit Watch(const VerdictMachine& its_machine) : machine(its_machine) {}

    VerdictMachine machine;
    std::optional<AxisHealth> health;                          ///< for axes that are directions in space
    std::optional<Readmission> readmission;                    ///< for such axes, where axes may return by themselves
    std::optional<ObserverReadmission> observer_readmission;  ///< for other channels, likewise
    std::array<AxisDiagnosis, max_axes> known{};  ///< the latest diagnosis of each isolated axis
    std::array<Diagnosis, max_axes> proved{};     ///< what its own values proved before it was isolated
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
    const AxisMask broken = watch_->health ? watch_->health->assess(measurement, watch_->machine.isolated()) : 0;
    Measurement sound = measurement;
    sound.valid &= ~broken;
    detector_->assess(sound, assessment_);

    const AxisMask before = watch_->machine.isolated();
    verdict_ = watch_->machine.update(measurement.identity, assessment_, broken);
    const AxisMask newly = watch_->machine.isolated() & ~before;
    if (watch_->readmission && newly != 0) watch_->readmission->excluded(newly, measurement, all_ & ~watch_->machine.isolated());
    after_change(before);
    remember_proofs(broken);
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

/// What an axis's own values prove is certain; else the method's diagnosis counts.
void FaultMonitor::remember_proofs(AxisMask broken)
{
    for (std::size_t axis = 0; axis < max_axes; ++axis) {
        AxisDiagnosis& known = watch_->known[axis];
        Diagnosis& proved = watch_->proved[axis];
        if (!has_axis(watch_->machine.isolated(), axis)) {
            known = {};
            proved = Diagnosis::none;
        }
        if (has_axis(broken, axis)) proved = diagnosis_of(watch_->health->fault(axis));
        if (assessment_.diagnosis[axis].kind != Diagnosis::none) known = assessment_.diagnosis[axis];
        if (proved != Diagnosis::none) known = {.kind = proved, .bias = known.bias, .bias_sigma = known.bias_sigma};
    }
}

FaultDiagnosis FaultMonitor::diagnosis() const
{
    FaultDiagnosis message;
    message.epoch = verdict_.epoch;
    message.sequence = verdict_.sequence;
    message.sample_time_ns = verdict_.sample_time_ns;
    message.unit = verdict_.unit;
    message.kind = verdict_.kind;
    message.provisional_mask = provisional_mask(verdict_);
    message.absent_mask = watch_->health ? watch_->health->absent() : 0;
    message.degraded_mask = assessment_.degraded & ~verdict_.isolated_mask;
    const AxisMask reported = verdict_.isolated_mask | message.provisional_mask | message.degraded_mask;
    for (std::size_t axis = 0; axis < max_axes; ++axis) {
        const AxisDiagnosis& known = watch_->known[axis];
        auto kind = has_axis(reported, axis) ? known.kind : Diagnosis::none;
        if (kind == Diagnosis::none && has_axis(message.absent_mask, axis)) kind = Diagnosis::absent;
        message.diagnosis[axis] = octet(kind);
        if (kind == Diagnosis::none || kind == Diagnosis::absent) continue;
        message.size[axis] = known.size;
        message.sigma[axis] = known.sigma;
        message.bias[axis] = known.bias;
        message.bias_sigma[axis] = known.bias_sigma;
    }
    return message;
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
