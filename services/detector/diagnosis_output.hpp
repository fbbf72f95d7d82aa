#pragma once

#include "quorient/bus/topics.hpp"
#include "quorient/fdi/fault_monitor.hpp"
#include "quorient/messages/fault_diagnosis.hpp"
#include "quorient/runtime/node.hpp"

namespace quorient::detector {

/// What a detector says of the kind and size of faults, and of axes that send nothing: on `quorient/diagnosis` when it changes, and once a
/// second while anything is wrong. Axes that fall silent, return, or are degraded become events.
class DiagnosisOutput {
public:
    DiagnosisOutput(bus::Bus& bus, runtime::Node& node, std::uint32_t detector);

    /// After each frame.
    void update(const fdi::FaultMonitor& monitor, const ClusterDescription& description);

    const FaultDiagnosis& latest() const { return latest_; }

private:
    bool is_due(const FaultDiagnosis& now) const;
    void report_changes(const FaultDiagnosis& now, const ClusterDescription& description);

    bus::Publisher<FaultDiagnosis> output_;
    runtime::Node& node_;
    std::uint32_t detector_;
    FaultDiagnosis latest_;
    FaultDiagnosis published_;
};

}  // namespace quorient::detector
