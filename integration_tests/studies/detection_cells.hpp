#pragma once

#include "detection_trial.hpp"
#include "monte_carlo.hpp"
#include "quorient/fdi/settings.hpp"

#include <span>
#include <string>
#include <vector>

namespace quorient::studies {

/// Trials of one kind: one fault, at random frames and on random axes of one recording.
struct Cell {
    std::size_t array = 0;  ///< place in the list of arrays
    bool moving = false;    ///< begins in the longest stretch without rest, else in a resting segment
    bool instruments = true;
    std::string fault_name;
    simulation::FaultSpec fault;
};

/// What became of the trials of one cell, for one method.
struct Reactions {
    std::size_t right = 0;
    std::size_t wrong = 0;
    std::size_t ambiguous = 0;
    std::size_t missed = 0;
    double median_detected_s = 0;    ///< over all trials; infinite where most were not detected
    double median_isolated_s = 0;    ///< over all trials, those not right as infinite
    double slowest_isolated_s = 0;   ///< slowest right isolation
    std::vector<double> isolated_s;  ///< each trial in order; infinite where not right
};

struct CellResult {
    Reactions ours;
    Reactions px4;
    double median_onset_error_s = 0;  ///< absolute; NaN where no attitude was compared
    double largest_onset_error_s = 0;
    double largest_attitude_error_rad = 0;
    std::size_t attitudes = 0;     ///< compared
    std::size_t beyond_bound = 0;  ///< trials beyond the attitude's bound
};

/// A whole recording without a fault.
struct HealthyRun {
    std::size_t array = 0;
    bool instruments = true;
    std::size_t false_isolations = 0;
    std::size_t ambiguous_frames = 0;
    std::size_t suspicious_frames = 0;  ///< in state SUSPECT
    double largest_statistic = 0;       ///< threshold 1
    std::size_t px4_isolations = 0;
    double duration_s = 0;
};

/// The product's detector for arrays, `accumulating`, with the motion noise that the other recording shows times `factor`.
fdi::FaultMonitor accumulating(const RecordedArray& array, bool instruments, double factor = 1);

/// The same with this motion noise.
fdi::FaultMonitor accumulating_with(const RecordedArray& array, bool instruments, const fdi::MotionNoise& noise);

/// Bias steps that begin in violent motion, instruments blamed.
std::vector<Cell> violent_steps(std::size_t array, std::span<const double> sizes_deg_s);

/// The upper one of two middle values; NaN of none.
double median(std::vector<double> values);

/// How the array under test is watched.
using MonitorOf = std::function<fdi::FaultMonitor(const RecordedArray&, bool instruments)>;

std::vector<CellResult> play_cells(const std::vector<RecordedArray>& arrays, const std::vector<Cell>& cells, const MonitorOf& monitor_of,
                                   const RunSettings& settings, const OnProgress& on_progress);

HealthyRun play_healthy(const std::vector<RecordedArray>& arrays, std::size_t array, bool instruments, const MonitorOf& monitor_of);

}  // namespace quorient::studies
