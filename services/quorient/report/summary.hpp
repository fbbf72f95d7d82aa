#pragma once

#include "quorient/system/system.hpp"
#include "quorient/evaluation/run_observer.hpp"

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

namespace quorient::report {

/// The run in words for people: the fault, each lane's isolation and errors, the voted stream.
std::string summary_text(const system::System& system, const evaluation::RunObserver& run);

/// The same for machines.
nlohmann::ordered_json summary_json(const system::System& system, const evaluation::RunObserver& run);

/// What the system file expects and the run did not show; empty when everything was met.
std::vector<std::string> unmet(const system::System& system, const evaluation::RunObserver& run);

}  // namespace quorient::report
