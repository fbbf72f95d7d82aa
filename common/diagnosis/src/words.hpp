#pragma once

#include "quorient/diagnosis/report.hpp"

#include <string>
#include <vector>

namespace quorient::diagnosis {

/// "g0", "g0 and g1", "g0, g1 and g2".
std::string list_of(const std::vector<std::string>& names);

/// The one sentence on top of a report that a pilot understands.
std::string sentence_of(const Report& report);

}  // namespace quorient::diagnosis
