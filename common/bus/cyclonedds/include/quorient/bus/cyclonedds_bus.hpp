#pragma once

#include "quorient/bus/bus.hpp"
#include "quorient/bus/own_samples.hpp"

namespace quorient::bus {

/// Joins a domain through Cyclone DDS. `settings` has no problems().
/// @returns why Cyclone refused.
tl::expected<std::unique_ptr<Bus>, std::string> open_cyclonedds(const Settings& settings, OwnSamples own = OwnSamples::received);

}  // namespace quorient::bus
