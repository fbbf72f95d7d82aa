#pragma once

#include "quorient/system/system.hpp"
#include "quorient/evaluation/run_observer.hpp"

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

namespace quorient::report {

/// A vessel's run in words: every fault of the truth, and what each lane made of it.
std::string vessel_text(const system::System& system, const evaluation::RunObserver& run);

/// The same for machines.
nlohmann::ordered_json vessel_json(const system::System& system, const evaluation::RunObserver& run);

/// What expect.each_fault_within_s asks for and a lane did not do: every fault isolated in time and held until it ended, no other
/// isolation, and a verdict for at least nine of ten frames (a lane that is silent is not right).
std::vector<std::string> unmet_faults(const system::System& system, const evaluation::RunObserver& run);

}  // namespace quorient::report
