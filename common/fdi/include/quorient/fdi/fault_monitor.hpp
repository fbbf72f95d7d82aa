#pragma once

#include "quorient/fdi/detector.hpp"
#include "quorient/fdi/settings.hpp"
#include "quorient/fdi/verdict_machine.hpp"
#include "quorient/geometry/sensor_cluster.hpp"
#include "quorient/messages/fault_verdict.hpp"
#include "quorient/messages/sensor_frame.hpp"

#include <memory>
#include <string>
#include <tl/expected.hpp>

namespace quorient::fdi {

/// The brain of the detector process: a method and the state machine behind it. One verdict per accepted frame.
class FaultMonitor {
public:
    /// @returns why this method cannot serve this cluster.
    static tl::expected<FaultMonitor, std::string> make(const DetectorSettings& detector, const VerdictSettings& verdict,
                                                        const geometry::SensorCluster& cluster);

    /// The verdict of this frame. Frames have passed the intake: in order, finite, of the described cluster.
    FaultVerdict assess(const SensorFrame& frame);

    /// Takes over the exclusions of a lane that went on while this detector was away.
    void adopt(const std::array<std::uint64_t, max_axes>& excluded_from);

    /// By command. @returns false where none of the axes was excluded.
    bool readmit(AxisMask axes);

private:
    FaultMonitor(std::unique_ptr<Detector> detector, VerdictMachine machine) : detector_(std::move(detector)), machine_(std::move(machine)) {}

    std::unique_ptr<Detector> detector_;
    VerdictMachine machine_;
};

}  // namespace quorient::fdi
