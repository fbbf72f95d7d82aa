#pragma once

#include "monte_carlo.hpp"
#include "cli/svg_plot.hpp"

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

namespace quorient::studies {

using Json = nlohmann::ordered_json;

/// What a study found: the same figures as a table, for machines, and as charts.
struct Report {
    std::string text;
    Json json;
    std::vector<cli::Chart> charts;
};

/// Methods x layouts x faults on white noise of sigma 1, beside an independent computation, and the
/// subset method over its margin.
Report isolation(const RunSettings& settings, const OnProgress& on_progress);

/// The figures of paper 002 that a fitted fault model reproduces, and those that none does.
Report paper_002(const RunSettings& settings, const OnProgress& on_progress);

/// The limits of one sample: the fault size that is detected in 99 of 100 samples, and isolation at 10 sigma, per layout.
Report ceiling(const RunSettings& settings, const OnProgress& on_progress);

/// False alarms and isolation of the observer schemes, with limits from noise and model error, and with a fixed threshold.
Report vessel(const RunSettings& settings, const OnProgress& on_progress);

/// Faults added to real recordings (settings.logs, two or more of the same sensors; each is corrected by the calibration of the next):
/// how soon the accumulating detector names them, beside the PX4 rule, and what it says of the recordings as they are.
Report detection_delay(const RunSettings& settings, const OnProgress& on_progress);

/// The same recordings without a fault and with steps in violent motion, with the detector's motion noise wrong by factors of 0.5 to 2.
Report motion_noise(const RunSettings& settings, const OnProgress& on_progress);

/// The steps in violent motion of detection_delay with five seeds from settings.seed on: how much their medians scatter.
Report detection_seeds(const RunSettings& settings, const OnProgress& on_progress);

/// The terms of the motion noise that each recording shows by itself, beside the usual ones, and what becomes of the other one with them.
Report motion_terms(const RunSettings& settings, const OnProgress& on_progress);

/// The field detector on logs of any arrays of triads (settings.logs: sound; settings.faulty_logs), uncalibrated: as they are, and with faults
/// added to the sound ones, beside the rules of PX4 and ArduPilot and the attitudes that these leave.
Report field(const RunSettings& settings, const OnProgress& on_progress);

/// The same with one rule of the detector switched off at a time: whom it blames then, and what it no longer finds.
Report field_ablation(const RunSettings& settings, const OnProgress& on_progress);

/// What the layout designer finds beside what is known to be best, with the time it takes, and the survey of survival over families.
Report array_design(const RunSettings& settings, const OnProgress& on_progress);

inline constexpr std::uint64_t isolation_trials = 100'000;
inline constexpr std::uint64_t paper_002_trials = 400'000;
inline constexpr std::uint64_t ceiling_trials = 200'000;
inline constexpr std::uint64_t vessel_trials = 100;
inline constexpr std::uint64_t detection_delay_trials = 60;
inline constexpr std::uint64_t motion_noise_trials = 30;
inline constexpr std::uint64_t detection_seeds_trials = 60;  // with each seed
inline constexpr std::uint64_t motion_terms_trials = 60;
inline constexpr std::uint64_t field_trials = 4;  // each fault in each log
inline constexpr std::uint64_t field_ablation_trials = 2;
inline constexpr std::uint64_t array_design_trials = 4000;

}  // namespace quorient::studies
