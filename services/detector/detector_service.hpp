#pragma once

#include "quorient/fdi/fault_monitor.hpp"
#include "quorient/messages/exclusions.hpp"
#include "quorient/runtime/frame_intake.hpp"
#include "quorient/runtime/node.hpp"
#include "quorient/system/system.hpp"

#include <optional>

namespace quorient::detector {

/// One verdict per frame. Promises: README.md.
class DetectorService {
public:
    DetectorService(const system::DetectorProcess& settings, bus::Bus& bus, runtime::EventLoop& loop);

private:
    /// What others say of exclusions.
    struct Memory {
        std::uint64_t epoch = 0;
        Exclusions excluded_from;
        bool known = false;
    };

    /// Frames [first, end) that never came here.
    struct Absence {
        std::uint64_t first = 0;
        std::uint64_t end = 0;
    };

    void on_frame(const SensorFrame& frame);
    void on_lane_attitude(const AttitudeState& attitude);
    void on_voted(const VotedAttitude& voted);
    void on_command(const FaultCommand& command);
    void answer(const FaultCommand& command, bool done, const std::string& text);
    void handle_accepted();
    bool prepare(const ClusterDescription& description);
    tl::expected<fdi::FaultMonitor, std::string> make_method(const ClusterDescription& description) const;
    tl::expected<fdi::FaultMonitor, std::string> make_observers(const ClusterDescription& description) const;
    void assess(const SensorFrame& frame);
    std::string describe(AxisMask axes) const;
    void tell_changes(const FaultVerdict& verdict);
    void remember(std::uint64_t epoch, const Exclusions& excluded_from, Memory& memory);
    void adopt_memories();
    void adopt_missed(const VotedAttitude& voted);
    bool look_at_readiness();  ///< @returns whether that is over

    system::DetectorProcess settings_;
    runtime::Node node_;
    bus::Publisher<FaultVerdict> verdicts_;
    bus::Subscription<SensorFrame>* frames_ = nullptr;
    runtime::FrameIntake intake_;
    std::optional<fdi::FaultMonitor> monitor_;
    FaultVerdict last_;
    unsigned unheard_looks_ = 0;  ///< at readiness, while nobody reads the verdicts
    bool adopting_ = true;        ///< until this detector's first judgement, or an order
    Memory of_lane_;              ///< what the lane's integrator remembers of this detector's life before
    Memory of_voters_;            ///< what a majority stands for: found while this detector was dead
    Absence absence_;             ///< the last one of the epoch
    std::int64_t arrival_ns_ = 0;
    std::uint64_t told_rejected_ = 0;
    std::uint64_t told_foreign_ = 0;
};

}  // namespace quorient::detector
