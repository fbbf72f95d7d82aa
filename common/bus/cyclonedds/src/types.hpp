#pragma once

#include "quorient/bus/topics.hpp"

#include <dds/dds.h>

namespace quorient::bus::cyclonedds {

/// The generated descriptor of a type. Its C struct is the plain struct, member by member (checked in types.cpp at compile time),
/// so a sample is handed over as it lies in memory.
const dds_topic_descriptor_t& descriptor_of(TypeId type);

}  // namespace quorient::bus::cyclonedds
