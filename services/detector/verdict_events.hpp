#pragma once

#include "quorient/messages/cluster_description.hpp"
#include "quorient/messages/fault_diagnosis.hpp"
#include "quorient/messages/fault_verdict.hpp"
#include "quorient/runtime/node.hpp"

#include <string>
#include <string_view>

namespace quorient::detector {

/// What an operator reads of a detector's verdicts: one event for each change, in the order of frames.
class VerdictEvents {
public:
    explicit VerdictEvents(runtime::Node& node) : node_(node) {}

    /// This verdict was published. @param reason  of the method, for a state that names no axis; may be empty
    /// @param diagnosis  kind and size of the faults, as far as they are known at this verdict
    void report_changes(const FaultVerdict& verdict, const ClusterDescription& description, std::string_view reason,
                        const FaultDiagnosis& diagnosis);

    const FaultVerdict& last() const { return last_; }

private:
    void report_isolations(const FaultVerdict& verdict, const ClusterDescription& description, const FaultDiagnosis& diagnosis);
    void report_provisional(const FaultVerdict& verdict, const ClusterDescription& description);
    void report_state(const FaultVerdict& verdict, const ClusterDescription& description, std::string_view reason);

    runtime::Node& node_;
    FaultVerdict last_;
};

}  // namespace quorient::detector
