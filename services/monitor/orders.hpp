#pragma once

#include "quorient/messages/fault_command.hpp"

#include <string>
#include <tl/expected.hpp>

namespace quorient::monitor {

/// An order as the page sends it: {"action": "inject", "fault": "axis=1,kind=bias,value=0.05,start=0"}, {"action": "clear"},
/// {"action": "readmit", "axes": [1]} or {"action": "reset", "attitude": [w, x, y, z]}.
/// @returns what is wrong with it.
tl::expected<FaultCommand, std::string> order_from(const std::string& json);

}  // namespace quorient::monitor
