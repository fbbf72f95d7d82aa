#pragma once

#include "quorient/bus/sender.hpp"

#include <dds/dds.h>
#include <cstdint>
#include <string>
#include <vector>

namespace quorient::bus::cyclonedds {

/// The participant of a writer that `reader` has matched. @param secured  as for make_sender()
Sender sender_of(dds_entity_t reader, dds_instance_handle_t writer, bool secured);

/// What a participant announces of itself; empty where it has left.
struct Announcement {
    std::string name;
    std::vector<std::uint8_t> user_data;
};

/// The announcement of the participant of a writer that `reader` has matched. Slow: once for each writer.
Announcement announcement_of_writer(dds_entity_t reader, dds_instance_handle_t writer);

}  // namespace quorient::bus::cyclonedds
