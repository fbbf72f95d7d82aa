#pragma once

#include "cli/json_output.hpp"

#include <string>

namespace quorient::cli {

/// The papers' tables beside ours: Table 4 of paper 004 (F_d2) and the accuracy table of paper 002, each row with the
/// difference and, where the paper errs or leaves a rule unstated, the reason.
Json papers_tables_json();
std::string papers_tables_text();

}  // namespace quorient::cli
