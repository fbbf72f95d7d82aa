#pragma once

#include "quorient/bus/topics.hpp"

#include <fastdds/dds/topic/TypeSupport.hpp>

namespace quorient::bus::fastdds {

/// The generated type. Its C++ class is the plain struct, member by member (sizes are checked here at compile time, places by a test),
/// so a sample is copied as it lies in memory.
eprosima::fastdds::dds::TypeSupport type_support_of(TypeId type);

}  // namespace quorient::bus::fastdds
