#pragma once

#include "quorient/fdi/fault_monitor.hpp"
#include "quorient/runtime/frame_intake.hpp"
#include "quorient/runtime/node.hpp"
#include "quorient/system/system.hpp"

#include <optional>

namespace quorient::detector {

/// One verdict per frame. Promises: README.md.
class ParityFdi {
public:
    ParityFdi(const system::DetectorProcess& settings, bus::Bus& bus, runtime::EventLoop& loop);

private:
    void on_frame(const SensorFrame& frame);
    void on_lane_attitude(const AttitudeState& attitude);
    void on_command(const FaultCommand& command);
    void handle_accepted();
    bool prepare(const ClusterDescription& description);
    void assess(const SensorFrame& frame);
    void tell_changes(const FaultVerdict& verdict);
    void adopt_from_lane();
    void look_at_readiness();

    system::DetectorProcess settings_;
    runtime::Node node_;
    bus::Publisher<FaultVerdict> verdicts_;
    bus::Subscription<SensorFrame>* frames_ = nullptr;
    runtime::FrameIntake intake_;
    std::optional<fdi::FaultMonitor> monitor_;
    FaultVerdict last_;
    bool adopting_ = true;                      ///< until this detector's first judgement, or an order
    std::optional<AttitudeState> lane_memory_;  ///< what the lane's integrator last said of exclusions
    std::int64_t arrival_ns_ = 0;
    std::uint64_t told_rejected_ = 0;
    std::uint64_t told_foreign_ = 0;
};

}  // namespace quorient::detector
