#pragma once

#include "quorient/bus/bus.hpp"

namespace quorient::bus {

/// Joins a domain through Cyclone DDS. `settings` has no problems().
/// @returns Cyclone's refusal in words.
tl::expected<std::unique_ptr<Bus>, std::string> open_cyclonedds(const Settings& settings);

}  // namespace quorient::bus
