#pragma once

#include "quorient/bus/sender.hpp"

#include <dds/dds.h>

namespace quorient::bus::cyclonedds {

/// The participant of a writer that `reader` has matched. @param secured  as for make_sender()
Sender sender_of(dds_entity_t reader, dds_instance_handle_t writer, bool secured);

}  // namespace quorient::bus::cyclonedds
