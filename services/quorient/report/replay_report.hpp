#pragma once

#include "quorient/messages/cluster_description.hpp"
#include "quorient/messages/fault_verdict.hpp"
#include "quorient/messages/voted_attitude.hpp"
#include "quorient/system/system.hpp"

#include <array>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

namespace quorient::report {

/// What each lane made of each injected fault, and what it blamed without cause. Times are the log's own.
class ReplayReport {
public:
    explicit ReplayReport(const system::System& system) : system_(system) {}

    void on_description(const ClusterDescription& description);
    void on_verdict(const FaultVerdict& verdict);
    void on_voted(const VotedAttitude& voted);

    nlohmann::ordered_json faults() const;
    nlohmann::ordered_json false_isolations() const;

    /// The last attitude that a frame stands behind.
    const std::optional<VotedAttitude>& final_attitude() const { return final_attitude_; }

private:
    struct Reaction {
        std::optional<double> detected_s;
        std::optional<double> isolated_s;
        AxisMask isolated = 0;
    };
    struct Fault {
        simulation::FaultSpec spec;
        std::vector<Reaction> lanes;
    };
    struct FalseIsolation {
        std::size_t lane;
        double time_s;
        AxisMask axes;
    };

    void judge(std::size_t lane, const FaultVerdict& verdict);

    const system::System& system_;
    std::vector<Fault> faults_;
    std::vector<FalseIsolation> false_isolations_;
    std::vector<AxisMask> isolated_;  // by lane
    std::optional<VotedAttitude> final_attitude_;
};

}  // namespace quorient::report
