#pragma once

#include "attitude_events.hpp"
#include "quorient/attitude/integrator.hpp"
#include "quorient/geometry/sensor_cluster.hpp"
#include "quorient/runtime/intake_report.hpp"
#include "quorient/runtime/node.hpp"
#include "quorient/runtime/shedding.hpp"
#include "quorient/system/system.hpp"
#include "reset_orders.hpp"

#include <optional>

namespace quorient::integrator {

/// One attitude per frame. Promises: README.md.
class IntegratorService {
public:
    IntegratorService(const system::IntegratorProcess& settings, bus::Bus& bus, runtime::EventLoop& loop);

private:
    void on_frame(const SensorFrame& frame);
    void on_verdict(const FaultVerdict& verdict);
    void on_description(const ClusterDescription& description);
    void on_voted(const VotedAttitude& voted);
    void on_command(const FaultCommand& command);
    void handle_accepted();
    bool prepare(const ClusterDescription& description, std::uint64_t first_sequence);
    bool same_axes(const ClusterDescription& description);
    void integrate(const SensorFrame& frame);
    void publish_pending();

    system::IntegratorProcess settings_;
    runtime::Node node_;
    bus::Publisher<AttitudeState> attitudes_;
    runtime::Shedding shedding_;
    runtime::Outlet<AttitudeState> outlet_;
    bus::Subscription<SensorFrame>* frames_ = nullptr;
    bus::Subscription<FaultVerdict>* verdicts_ = nullptr;
    runtime::Timer& patience_timer_;
    intake::FrameIntake intake_;
    runtime::IntakeReport intake_report_;
    AttitudeEvents events_;
    ResetOrders resets_;
    std::optional<attitude::Integrator> integrator_;  ///< from the first frame on
    geometry::Axes axes_;                             ///< those of integrator_
    bool follows_ = true;                             ///< the present description is of these axes
    std::optional<VotedAttitude> first_voted_;        ///< newest that came before integrator_ was made
    std::optional<FaultVerdict> verdict_;             ///< newest of the lane's detector
    std::optional<Identity> pending_;                 ///< integrated, not yet published
    Stamps stamps_{};
    std::int64_t arrival_ns_ = 0;
};

}  // namespace quorient::integrator
