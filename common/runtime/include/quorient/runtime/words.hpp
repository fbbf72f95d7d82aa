#pragma once

#include "quorient/messages/codes.hpp"

#include <string_view>

namespace quorient::runtime {

/// The words that operators and `--json` read for the codes of messages.
std::string_view to_string(Severity severity);
std::string_view to_string(EventCode code);
std::string_view to_string(ServiceRole role);
std::string_view to_string(ServiceState state);
std::string_view to_string(VerdictState state);
std::string_view to_string(AttitudeMode mode);
std::string_view to_string(VoteLevel level);
std::string_view to_string(LaneExclusion why);

}  // namespace quorient::runtime
