#pragma once

#include "quorient/attitude/integrator.hpp"
#include "quorient/geometry/sensor_cluster.hpp"
#include "quorient/runtime/frame_intake.hpp"
#include "quorient/runtime/node.hpp"
#include "quorient/system/system.hpp"

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
    void obey(const FaultCommand& command);
    void refuse(const FaultCommand& command, const std::string& why);
    void refuse_waiting_reset(const char* what_became_of_its_frame);
    std::string reset_attitude(const FaultCommand& command);
    void handle_accepted();
    bool prepare(const ClusterDescription& description, std::uint64_t first_sequence);
    std::string names_of(AxisMask axes) const;
    bool same_axes(const ClusterDescription& description);
    void integrate(const SensorFrame& frame);
    void mend_seed(const VotedAttitude& voted);
    void rejoin(const VotedAttitude& voted);
    void publish_pending();
    void tell_changes(const AttitudeState& attitude);
    bool look_at_readiness();  ///< @returns whether that is over

    system::IntegratorProcess settings_;
    runtime::Node node_;
    bus::Publisher<AttitudeState> attitudes_;
    bus::Subscription<SensorFrame>* frames_ = nullptr;
    bus::Subscription<FaultVerdict>* verdicts_ = nullptr;
    runtime::Timer& patience_timer_;
    runtime::Timer& reset_timer_;
    runtime::FrameIntake intake_;
    std::optional<attitude::Integrator> integrator_;
    geometry::Axes axes_;                        ///< of integrator_
    bool follows_ = true;                        ///< the present description is of these axes
    std::optional<VotedAttitude> voted_;         ///< newest, until this integrator has started
    std::optional<FaultVerdict> verdict_;        ///< newest of the lane's detector
    std::optional<Identity> pending_;            ///< integrated, not yet published
    std::optional<Identity> absent_until_;       ///< first frame after an absence of this process
    std::optional<FaultCommand> waiting_reset_;  ///< for its frame
    AttitudeState last_;
    Stamps stamps_{};
    std::int64_t arrival_ns_ = 0;
    std::uint64_t told_rejected_ = 0;
    std::uint64_t told_foreign_ = 0;
    std::uint64_t told_too_short_ = 0;
};

}  // namespace quorient::integrator
