#pragma once

#include "quorient/bus/settings.hpp"

#include <string>

namespace quorient::bus::cyclonedds {

/// Cyclone's configuration. Without GenerateKeyhash Fast DDS does not notice that a Cyclone endpoint leaves. The short heartbeat and NACK
/// delays repair a lost sample before any consumer's patience ends.
/// @param shared  samples travel by iceoryx where a topic allows it
/// @returns XML as dds_create_domain takes it
std::string configuration(const Settings& settings, bool shared);

}  // namespace quorient::bus::cyclonedds
