#pragma once

#include "quorient/evaluation/run_observer.hpp"

#include <nlohmann/json.hpp>
#include <string>

namespace quorient::report {

/// What the lanes left undecided, one line for each lane and state: "lane a   PROVISIONAL for 0.42 s in 3 spells, the longest from 7.080 s to
/// 7.300 s (IMU1)". Empty where there was nothing.
std::string undecided_text(const evaluation::RunObserver& run);

/// Seconds by lane and state.
nlohmann::ordered_json undecided_s_json(const evaluation::RunObserver& run);

/// The single spells: lane, state, axes, names, from_s, to_s.
nlohmann::ordered_json undecided_json(const evaluation::RunObserver& run);

}  // namespace quorient::report
