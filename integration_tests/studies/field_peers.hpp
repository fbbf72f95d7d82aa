#pragma once

#include "field_attitude.hpp"
#include "field_fault.hpp"

#include "quorient/diagnosis/px4_rule.hpp"

#include <optional>
#include <vector>

namespace quorient::studies {

/// PX4's rule on a log without the start biases of a resting first second; frames with a missing axis are passed over.
class Px4OnLog {
public:
    /// @param from  the first frame that is played
    Px4OnLog(const FieldLog& log, std::size_t from);

    /// @returns the axes of the instrument that it calls faulty, 0 = none
    AxisMask update(SensorFrame frame);

private:
    AxisMask all_;
    diagnosis::Px4Rule rule_;
    std::vector<double> bias_;
};

/// Whether ArduPilot's check before arming notices this fault: on a log that begins at rest, until the body moves. In flight it compares no gyros.
bool refuses_to_arm(const FieldLog& log, const Injection& injection, std::uint64_t seed);

/// The attitude of an autopilot that flies by one gyro, the faulty one, until it changes to a sound one, whose own attitude the fault has not reached.
class FlownByOne {
public:
    FlownByOne(const geometry::SensorCluster& cluster, AxisMask faulty) : spoiled_(cluster, faulty), sound_(cluster, faulty) {}

    void add(const SensorFrame& spoiled, const SensorFrame& as_logged);

    /// @param changed  after how many frames it flew by another gyro, if ever
    AttitudeError error(std::optional<std::size_t> changed) const;

    std::size_t size() const { return sound_.size(); }

private:
    Attitude spoiled_;
    Attitude sound_;
};

}  // namespace quorient::studies
