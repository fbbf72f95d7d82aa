#pragma once

#include "quorient/bus/topics.hpp"

#include <dds/dds.h>

namespace quorient::bus::cyclonedds {

/// ROS 2's types have strings and sequences. Their C structs differ from the plain ones, so samples are converted.
bool is_ros2(TypeId type);

const dds_topic_descriptor_t& ros2_descriptor_of(TypeId type);

/// @param message  the plain struct of ros2.hpp. @returns false where the vendor refused it.
bool write_ros2(TypeId type, dds_entity_t writer, const void* message);

/// Takes the oldest sample into the plain struct. @returns false when there is none.
bool take_ros2(TypeId type, dds_entity_t reader, void* message);

}  // namespace quorient::bus::cyclonedds
