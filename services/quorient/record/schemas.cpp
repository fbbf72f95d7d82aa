#include "schemas.hpp"

#include "contract_text.hpp"

#include <fmt/format.h>
#include <array>
#include <cassert>

namespace quorient::record {

namespace {

/// In the order of TypeId.
constexpr std::array<std::string_view, bus::type_count> type_names{"ClusterDescription", "SensorFrame",   "TruthState",  "FaultVerdict",
                                                                   "FaultDiagnosis",     "AttitudeState", "VoterOutput", "VotedAttitude",
                                                                   "HealthEvent",        "ServiceStatus", "FaultCommand"};

/// The struct's definition, from its first line to its last.
std::string_view definition_of(std::string_view type)
{
    const auto begin = contract_text.find(fmt::format("  @final struct {} {{", type));
    assert(begin != std::string_view::npos);
    constexpr std::string_view last_line = "\n  };\n";
    return contract_text.substr(begin, contract_text.find(last_line, begin) + last_line.size() - begin);
}

constexpr std::string_view imu_text = R"(std_msgs/Header header
geometry_msgs/Quaternion orientation
float64[9] orientation_covariance
geometry_msgs/Vector3 angular_velocity
float64[9] angular_velocity_covariance
geometry_msgs/Vector3 linear_acceleration
float64[9] linear_acceleration_covariance
================================================================================
MSG: std_msgs/Header
builtin_interfaces/Time stamp
string frame_id
================================================================================
MSG: builtin_interfaces/Time
int32 sec
uint32 nanosec
================================================================================
MSG: geometry_msgs/Quaternion
float64 x
float64 y
float64 z
float64 w
================================================================================
MSG: geometry_msgs/Vector3
float64 x
float64 y
float64 z
)";

constexpr std::string_view transform_text = R"({
  "title": "foxglove.FrameTransform",
  "type": "object",
  "properties": {
    "timestamp": {
      "title": "time", "type": "object",
      "properties": {"sec": {"type": "integer", "minimum": 0}, "nsec": {"type": "integer", "minimum": 0, "maximum": 999999999}}
    },
    "parent_frame_id": {"type": "string"},
    "child_frame_id": {"type": "string"},
    "translation": {
      "title": "foxglove.Vector3", "type": "object",
      "properties": {"x": {"type": "number"}, "y": {"type": "number"}, "z": {"type": "number"}},
      "required": ["x", "y", "z"]
    },
    "rotation": {
      "title": "foxglove.Quaternion", "type": "object",
      "properties": {"x": {"type": "number"}, "y": {"type": "number"}, "z": {"type": "number"}, "w": {"type": "number"}},
      "required": ["x", "y", "z", "w"]
    }
  },
  "required": ["timestamp", "parent_frame_id", "child_frame_id", "translation", "rotation"]
})";

}  // namespace

Schema contract_schema(bus::TypeId type)
{
    const auto name = type_names.at(static_cast<std::size_t>(type));
    return {fmt::format("quorient_msgs::{}", name), "omgidl", fmt::format("module quorient_msgs {{\n{}}};\n", definition_of(name)), "cdr"};
}

Schema transform_schema()
{
    return {"foxglove.FrameTransform", "jsonschema", std::string{transform_text}, "json"};
}

Schema imu_schema()
{
    return {"sensor_msgs/msg/Imu", "ros2msg", std::string{imu_text}, "cdr"};
}

}  // namespace quorient::record
