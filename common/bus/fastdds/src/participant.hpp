#pragma once

#include "peers.hpp"
#include "quorient/bus/settings.hpp"
#include "version.hpp"

#include <string>
#include <tl/expected.hpp>

#include <fastdds/dds/domain/DomainParticipant.hpp>

namespace quorient::bus::fastdds {

Duration seconds(double s);

bool shares_memory(const Settings& settings);

/// Checks the room for shared memory. Without room Fast DDS would be ended by SIGBUS at its first sample.
/// @returns `settings`, by UDP alone where shared memory was preferred; an explanation where it was required.
tl::expected<Settings, std::string> with_room_in_shared_memory(Settings settings);

/// A participant with the transports, announced addresses, peers and discovery periods of the settings.
/// @param peers  receives the other participants; must outlive this one. @returns null if the domain cannot be joined.
dds::DomainParticipant* join(const Settings& settings, Peers& peers);

}  // namespace quorient::bus::fastdds
