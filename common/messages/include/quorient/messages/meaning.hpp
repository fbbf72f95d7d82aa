#pragma once

#include "quorient/messages/attitude_state.hpp"
#include "quorient/messages/cluster_description.hpp"
#include "quorient/messages/codes.hpp"
#include "quorient/messages/fault_command.hpp"
#include "quorient/messages/fault_diagnosis.hpp"
#include "quorient/messages/fault_verdict.hpp"
#include "quorient/messages/health_event.hpp"
#include "quorient/messages/sensor_frame.hpp"
#include "quorient/messages/service_status.hpp"
#include "quorient/messages/voted_attitude.hpp"

#include <cstddef>
#include <cstdint>

namespace quorient {

/// A code as it travels.
template <class Code>
constexpr std::uint8_t octet(Code code)
{
    return static_cast<std::uint8_t>(code);
}

/// A code from the wire; what this contract does not know is `unknown`.
template <class Code>
constexpr Code code_from(std::uint8_t octet, Code last)
{
    return octet <= static_cast<std::uint8_t>(last) ? static_cast<Code>(octet) : Code{};
}

constexpr SensorKind sensor_kind(std::uint8_t kind)
{
    return code_from(kind, SensorKind::vessel_rates);
}
constexpr SensorKind kind_of(const ClusterDescription& description)
{
    return sensor_kind(description.kind);
}
constexpr SensorKind kind_of(const SensorFrame& frame)
{
    return sensor_kind(frame.kind);
}
constexpr SensorKind kind_of(const FaultVerdict& verdict)
{
    return sensor_kind(verdict.kind);
}
constexpr InitialAttitude initial_attitude_of(const ClusterDescription& description)
{
    return code_from(description.initial_attitude_known, InitialAttitude::measured);
}
constexpr VerdictState state_of(const FaultVerdict& verdict)
{
    return code_from(verdict.state, VerdictState::saturated);
}
constexpr Diagnosis diagnosis_of(const FaultDiagnosis& diagnosis, std::size_t axis)
{
    return code_from(diagnosis.diagnosis[axis], Diagnosis::absent);
}
constexpr AttitudeMode mode_of(const AttitudeState& attitude)
{
    return code_from(attitude.mode, AttitudeMode::truth);
}
constexpr AttitudeMode mode_of(const VotedAttitude& voted)
{
    return code_from(voted.mode, AttitudeMode::truth);
}
constexpr VoteLevel level_of(const VotedAttitude& voted)
{
    return code_from(voted.level, VoteLevel::lost);
}
constexpr LaneExclusion exclusion_of(const VotedAttitude& voted, std::size_t place)
{
    return code_from(voted.excluded_why[place], LaneExclusion::invalid);
}
constexpr EventCode code_of(const HealthEvent& event)
{
    return static_cast<EventCode>(event.code);  // codes have gaps; to_string() calls those without a name UNKNOWN
}
constexpr Severity severity_of(const HealthEvent& event)
{
    return code_from(event.severity, Severity::fatal);
}
constexpr ServiceState state_of(const ServiceStatus& status)
{
    return code_from(status.state, ServiceState::stopping);
}
constexpr ServiceRole role_of(const ServiceStatus& status)
{
    return code_from(status.role, ServiceRole::monitor);
}
constexpr Vendor vendor_of(const ServiceStatus& status)
{
    return code_from(status.vendor, Vendor::cyclonedds);
}
constexpr Transport transport_of(const ServiceStatus& status)
{
    return code_from(status.transport, Transport::iceoryx);
}
constexpr CommandAction action_of(const FaultCommand& command)
{
    return code_from(command.action, CommandAction::reset_attitude);
}
constexpr FaultKind fault_of(const FaultCommand& command)
{
    return code_from(command.kind, FaultKind::spike);
}

/// The frame contradicts a fault-free cluster, or an axis is known to be faulty.
constexpr bool sees_fault(const FaultVerdict& verdict)
{
    switch (state_of(verdict)) {
        case VerdictState::suspect:
        case VerdictState::isolated:
        case VerdictState::ambiguous:
        case VerdictState::blind:
        case VerdictState::provisional:
            return true;
        default:
            return false;
    }
}

/// Axes that are left out and not isolated: until the contradiction ends or is confirmed.
template <class Message>
constexpr AxisMask provisional_mask(const Message& message)
{
    return message.excluded_from.mask() & ~message.isolated_mask;
}

/// A majority of lanes stands behind this attitude and its exclusions.
constexpr bool is_vouched(const VotedAttitude& voted)
{
    return level_of(voted) == VoteLevel::full || level_of(voted) == VoteLevel::degraded;
}

}  // namespace quorient
