#pragma once

#include "cli/json_output.hpp"

namespace quorient::cli {

/// The paper's run (80 s, 100 Hz, no noise, threshold 1e-3): gains, means over windows and shares of samples decided rightly, each beside
/// the figure that an independent computation of the repaired equations gave. The paper itself prints none of them.
void print_vessel_table();

/// The same for machines.
Json vessel_table_json();

}  // namespace quorient::cli
