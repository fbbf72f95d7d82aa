#pragma once

#include "quorient/evaluation/fault_spells.hpp"
#include "quorient/messages/cluster_description.hpp"
#include "quorient/messages/fault_diagnosis.hpp"
#include "quorient/messages/fault_verdict.hpp"
#include "quorient/messages/voted_attitude.hpp"
#include "quorient/system/system.hpp"

#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

namespace quorient::report {

/// What each lane made of each stated fault, and all that it isolated. Times are the log's own.
class ReplayReport {
public:
    explicit ReplayReport(const system::System& system) : system_(system) {}

    void on_description(const ClusterDescription& description);
    void on_verdict(const FaultVerdict& verdict);
    void on_diagnosis(const FaultDiagnosis& diagnosis);
    void on_voted(const VotedAttitude& voted);

    nlohmann::ordered_json faults() const;

    /// Isolations by lane, with the names of their axes and what is wrong with them, as far as it is known at the end.
    nlohmann::ordered_json isolations() const;

    /// Those of them that contradict a truth: empty where no fault was stated, since a log as it is may well hold one.
    nlohmann::ordered_json false_isolations() const;

    /// The last attitude that a frame stands behind.
    const std::optional<VotedAttitude>& final_attitude() const { return final_attitude_; }

private:
    struct Fault {
        simulation::FaultSpec spec;
        std::vector<evaluation::Reaction> lanes;
    };
    struct Isolation {
        std::size_t lane;
        double time_s;
        AxisMask axes;
        bool is_stated;  ///< a stated fault had begun in one of these axes
    };
    struct Lane {
        AxisMask isolated = 0;
        FaultDiagnosis diagnosis;
    };

    void judge(std::size_t lane, const FaultVerdict& verdict);

    const system::System& system_;
    std::vector<Fault> faults_;
    std::vector<Isolation> isolations_;
    std::vector<Lane> lanes_;
    ClusterDescription description_;
    std::optional<VotedAttitude> final_attitude_;
};

}  // namespace quorient::report
