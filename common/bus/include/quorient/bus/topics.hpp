#pragma once

#include "quorient/bus/qos.hpp"
#include "quorient/messages/attitude_state.hpp"
#include "quorient/messages/cluster_description.hpp"
#include "quorient/messages/fault_command.hpp"
#include "quorient/messages/fault_diagnosis.hpp"
#include "quorient/messages/fault_verdict.hpp"
#include "quorient/messages/health_event.hpp"
#include "quorient/messages/sensor_frame.hpp"
#include "quorient/messages/service_status.hpp"
#include "quorient/messages/truth_state.hpp"
#include "quorient/messages/voted_attitude.hpp"

#include <cstddef>
#include <tuple>

namespace quorient::bus {

/// The types of the IDL, and behind them those of ROS 2 (ros2.hpp). VoterOutput and VotedAttitude differ in their keys alone and share one
/// plain struct.
enum class TypeId : std::size_t {
    cluster_description,
    sensor_frame,
    truth_state,
    fault_verdict,
    fault_diagnosis,
    attitude_state,
    voter_output,
    voted_attitude,
    health_event,
    service_status,
    fault_command,
    ros2_imu,
    ros2_diagnostics,
};
inline constexpr std::size_t type_count = 11;  ///< types in the IDL

/// A topic as a vendor's bus sees it.
struct TopicSpec {
    const char* name;
    TypeId type;
    std::size_t size;  ///< size of the plain struct
    Qos qos;
};

template <class M>
struct Topic {
    using Message = M;
    TopicSpec spec;

    constexpr Topic(const char* name, TypeId type, Qos qos) : spec{name, type, sizeof(M), qos} {}
};

namespace topics {

// Hot topics carry no deadline and AUTOMATIC liveliness: anything else silently turns iceoryx off.
inline constexpr Topic<ClusterDescription> cluster{
    "quorient/cluster", TypeId::cluster_description, {.transient_local = true, .depth = 1, .latched = true}};
inline constexpr Topic<SensorFrame> frame{"quorient/frame", TypeId::sensor_frame, {}};
inline constexpr Topic<TruthState> truth{"quorient/truth", TypeId::truth_state, {}};
inline constexpr Topic<FaultVerdict> verdict{"quorient/verdict", TypeId::fault_verdict, {.transient_local = true}};
inline constexpr Topic<FaultDiagnosis> diagnosis{
    "quorient/diagnosis", TypeId::fault_diagnosis, {.transient_local = true, .depth = 1, .latched = true}};
inline constexpr Topic<AttitudeState> attitude{"quorient/attitude", TypeId::attitude_state, {.transient_local = true}};
inline constexpr Topic<VotedAttitude> voter_output{"quorient/voter_output", TypeId::voter_output, {.transient_local = true}};
// No history: a late reader would also receive the weaker voters' history, behind frames that it has already read.
inline constexpr Topic<VotedAttitude> voted{"quorient/voted", TypeId::voted_attitude, {.exclusive = true}};
inline constexpr Topic<HealthEvent> event{"quorient/event", TypeId::health_event, {.transient_local = true, .depth = 256, .latched = true}};
inline constexpr Topic<ServiceStatus> status{"quorient/status", TypeId::service_status, {.reliable = false, .depth = 8}};
inline constexpr Topic<FaultCommand> command{"quorient/command", TypeId::fault_command, {.depth = 64}};

/// Every topic, for tools that treat them alike.
inline constexpr auto all = std::tuple{cluster, frame, truth, verdict, diagnosis, attitude, voter_output, voted, event, status, command};

}  // namespace topics
}  // namespace quorient::bus
