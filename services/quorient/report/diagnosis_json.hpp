#pragma once

#include "cli/json_output.hpp"

#include "quorient/diagnosis/report.hpp"

namespace quorient::cli {

/// The contract of `quorient diagnose --json` (docs/diagnose.md): keys may be added, none is renamed.
Json diagnosis_json(const diagnosis::Report& report);

}  // namespace quorient::cli
