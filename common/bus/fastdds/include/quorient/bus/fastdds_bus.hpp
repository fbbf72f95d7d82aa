#pragma once

#include "quorient/bus/bus.hpp"
#include "quorient/bus/own_samples.hpp"

namespace quorient::bus {

/// Joins a domain through Fast DDS. `settings` has no problems().
/// @returns why Fast DDS refused.
tl::expected<std::unique_ptr<Bus>, std::string> open_fastdds(const Settings& settings, OwnSamples own = OwnSamples::received);

}  // namespace quorient::bus
