#pragma once

#include "quorient/bus/bus.hpp"

namespace quorient::bus {

/// Joins a domain through Fast DDS. `settings` has no problems().
/// @returns Fast DDS's refusal in words.
tl::expected<std::unique_ptr<Bus>, std::string> open_fastdds(const Settings& settings);

}  // namespace quorient::bus
