#pragma once

#include "quorient/diagnosis/report.hpp"

#include <string>

namespace quorient::cli {

/// The report as lines for a terminal.
std::string diagnosis_text(const diagnosis::Report& report);

}  // namespace quorient::cli
