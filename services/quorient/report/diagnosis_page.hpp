#pragma once

#include "quorient/diagnosis/report.hpp"

#include <string>

namespace quorient::cli {

/// The report as one HTML page that stands for itself: no script, no network, readable on a phone and on paper.
std::string diagnosis_page(const diagnosis::Report& report);

}  // namespace quorient::cli
