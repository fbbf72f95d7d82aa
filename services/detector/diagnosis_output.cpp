#include "diagnosis_output.hpp"

#include "quorient/messages/diagnosis_text.hpp"
#include "quorient/messages/meaning.hpp"
#include "quorient/messages/words.hpp"

#include <fmt/format.h>

namespace quorient::detector {
namespace {

constexpr std::int64_t period_ns = 1'000'000'000;

bool says_anything(const FaultDiagnosis& diagnosis)
{
    return diagnosis.provisional_mask != 0 || diagnosis.absent_mask != 0 || diagnosis.degraded_mask != 0 ||
           diagnosis.diagnosis != decltype(diagnosis.diagnosis){};
}

}  // namespace

DiagnosisOutput::DiagnosisOutput(bus::Bus& bus, runtime::Node& node, std::uint32_t detector)
    : output_(bus.advertise(bus::topics::diagnosis)), node_(node), detector_(detector)
{
}

void DiagnosisOutput::update(const fdi::FaultMonitor& monitor, const ClusterDescription& description)
{
    FaultDiagnosis now = monitor.diagnosis();
    now.detector = detector_;
    report_changes(now, description);
    latest_ = now;
    if (!is_due(now)) return;
    output_.publish(now);
    published_ = now;
}

bool DiagnosisOutput::is_due(const FaultDiagnosis& now) const
{
    const bool changed = now.epoch != published_.epoch || now.provisional_mask != published_.provisional_mask ||
                         now.absent_mask != published_.absent_mask || now.degraded_mask != published_.degraded_mask ||
                         now.diagnosis != published_.diagnosis;
    return changed || (says_anything(now) && now.sample_time_ns - published_.sample_time_ns >= period_ns);
}

void DiagnosisOutput::report_changes(const FaultDiagnosis& now, const ClusterDescription& description)
{
    const Identity identity{now.epoch, now.sequence};
    const AxisMask silent = now.absent_mask & ~latest_.absent_mask;
    const AxisMask back = latest_.absent_mask & ~now.absent_mask;
    const AxisMask degraded = now.degraded_mask & ~latest_.degraded_mask;
    if (silent != 0)
        node_.report_throttled(EventCode::absent, Severity::warning_low, identity, silent,
                               fmt::format("ABSENT {}: left out while there is no data", axis_names(description, silent)));
    if (back != 0)
        node_.report_throttled(EventCode::present, Severity::info, identity, back, fmt::format("PRESENT {}", axis_names(description, back)));
    if (degraded != 0)
        node_.report_throttled(EventCode::degraded, Severity::warning_low, identity, degraded,
                               fmt::format("DEGRADED {}: {}", axis_names(description, degraded), diagnoses_text(now, description, degraded)));
}

}  // namespace quorient::detector
