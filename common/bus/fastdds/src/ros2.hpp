#pragma once

#include "quorient/bus/topics.hpp"

#include <fastdds/dds/topic/TypeSupport.hpp>

namespace quorient::bus::fastdds {

/// ROS 2's types have strings and sequences. Their classes differ from the plain structs, so samples are converted.
bool is_ros2(TypeId type);

eprosima::fastdds::dds::TypeSupport ros2_type_support_of(TypeId type);

/// @param message  the plain struct of ros2.hpp. @param sample  the generated class.
void ros2_to_vendor(TypeId type, const void* message, void* sample);
void ros2_from_vendor(TypeId type, const void* sample, void* message);

}  // namespace quorient::bus::fastdds
