#pragma once

#include "quorient/messages/cluster_description.hpp"
#include "quorient/messages/codes.hpp"
#include "quorient/messages/limits.hpp"

#include <string>
#include <string_view>

namespace quorient {

/// The words that operators and `--json` read for the codes of messages. What has no word is UNKNOWN.
std::string_view to_string(SensorKind kind);
std::string_view to_string(Severity severity);
std::string_view to_string(EventCode code);
std::string_view to_string(ServiceRole role);
std::string_view to_string(ServiceState state);
std::string_view to_string(VerdictState state);
std::string_view to_string(Diagnosis diagnosis);
std::string_view to_string(AttitudeMode mode);
std::string_view to_string(VoteLevel level);
std::string_view to_string(LaneExclusion why);
std::string_view to_string(CommandAction action);

/// What an operator calls an axis: "IMU3 y" where its instrument has several axes, else the instrument's name alone ("G2", "yaw_rate").
/// An axis that the description does not have is "axis 7".
std::string axis_name(const ClusterDescription& description, std::size_t axis);

/// "IMU3" where a whole instrument is in the mask, else its axes: "G2", "IMU3 y", "IMU1, IMU3 y"; "no axis" for an empty mask.
std::string axis_names(const ClusterDescription& description, AxisMask axes);

/// Before the description is known: "axis 7", "axes 1, 7", "no axis".
std::string axis_numbers(AxisMask axes);

}  // namespace quorient
