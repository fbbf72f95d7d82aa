#pragma once

#include "adoption.hpp"
#include "diagnosis_output.hpp"
#include "quorient/fdi/fault_monitor.hpp"
#include "quorient/runtime/intake_report.hpp"
#include "quorient/runtime/node.hpp"
#include "quorient/runtime/shedding.hpp"
#include "quorient/system/system.hpp"
#include "verdict_events.hpp"

#include <optional>

namespace quorient::detector {

/// One verdict per frame. Promises: README.md.
class DetectorService {
public:
    DetectorService(const system::DetectorProcess& settings, bus::Bus& bus, runtime::EventLoop& loop);

private:
    void on_frame(const SensorFrame& frame);
    void on_lane_attitude(const AttitudeState& attitude);
    void on_voted(const VotedAttitude& voted);
    void on_command(const FaultCommand& command);
    void answer(const FaultCommand& command, bool done, const std::string& text);
    void handle_accepted();
    bool prepare(const ClusterDescription& description);
    void assess(const SensorFrame& frame);
    void send(const FaultVerdict& verdict);
    bool is_news(const FaultVerdict& verdict) const;
    void adopt(const Exclusions& exclusions);
    bool has_all_it_needs();  ///< asked until it is so

    system::DetectorProcess settings_;
    runtime::Node node_;
    bus::Publisher<FaultVerdict> verdicts_;
    runtime::Shedding shedding_;
    runtime::Outlet<FaultVerdict> outlet_;
    DiagnosisOutput diagnosis_;
    bus::Subscription<SensorFrame>* frames_ = nullptr;
    intake::FrameIntake intake_;
    runtime::IntakeReport intake_report_;
    VerdictEvents events_;
    Adoption adoption_;
    std::optional<fdi::FaultMonitor> monitor_;  ///< from the first description that its method serves
    unsigned unmatched_looks_ = 0;              ///< at readiness, while nobody reads the verdicts
    std::int64_t arrival_ns_ = 0;
};

}  // namespace quorient::detector
