#pragma once

#include "quorient/attitude/integrator.hpp"
#include "quorient/messages/attitude_state.hpp"
#include "quorient/messages/cluster_description.hpp"
#include "quorient/runtime/node.hpp"

namespace quorient::integrator {

/// What an operator reads of the attitude's changes: one event each, in the order of frames.
class AttitudeEvents {
public:
    explicit AttitudeEvents(runtime::Node& node) : node_(node) {}

    /// This attitude was published. @param too_short  verdicts so far that reached further back than the history
    void report_changes(const AttitudeState& attitude, const ClusterDescription& description, std::uint64_t too_short);

    /// A voted attitude was taken over in place of another one that had a fault in it.
    void report_mending(Identity identity, const attitude::Integrator::Mending& mending, const ClusterDescription& description);

    const AttitudeState& last() const { return last_; }

private:
    void report_correction(const AttitudeState& attitude, const ClusterDescription& description);
    void report_mode(const AttitudeState& attitude);

    runtime::Node& node_;
    AttitudeState last_;
    std::uint64_t reported_too_short_ = 0;
};

}  // namespace quorient::integrator
