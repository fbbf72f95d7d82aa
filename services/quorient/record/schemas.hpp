#pragma once

#include "quorient/bus/topics.hpp"

#include <string>

namespace quorient::record {

/// How a channel's messages are described in an MCAP file.
struct Schema {
    std::string name;
    std::string encoding;          ///< how the text is written
    std::string text;
    std::string message_encoding;  ///< how the messages are
};

/// A type of the wire contract, by its own part of the IDL file that the vendors' generators compile.
Schema contract_schema(bus::TypeId type);

/// Foxglove's FrameTransform: viewers draw it. Messages in JSON.
Schema transform_schema();

/// ROS 2's sensor_msgs/msg/Imu. Messages in CDR.
Schema imu_schema();

}  // namespace quorient::record
