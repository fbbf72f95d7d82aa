#include "detection_cells.hpp"

#include "cli/parallel.hpp"
#include "quorient/diagnosis/px4_rule.hpp"
#include "arrays/accumulating_detector.hpp"
#include "quorient/messages/meaning.hpp"

#include <fmt/format.h>
#include <algorithm>
#include <boost/random/uniform_int_distribution.hpp>
#include <cassert>
#include <cmath>
#include <numbers>
#include <random>

namespace quorient::studies {

using diagnosis::Px4Rule;

namespace {

/// Frames of the recording that a fault of this cell may begin with: the horizon, and the beginning of the detector, fit.
std::vector<std::size_t> possible_onsets(const RecordedArray& array, bool moving)
{
    constexpr std::size_t least_before = 100;
    const auto horizon = static_cast<std::size_t>(std::lround(horizon_s / array.cluster.interval_s));
    const auto segments = moving ? std::vector{array.motion} : array.rest;
    std::vector<std::size_t> onsets;
    for (const auto& segment : segments)
        for (std::size_t i = std::max(segment.begin, least_before); i < segment.end && i + horizon < array.frames.size(); ++i)
            onsets.push_back(i);
    return onsets;
}

Trial drawn(const RecordedArray& array, const Cell& cell, const std::vector<std::size_t>& onsets, std::seed_seq& seed)
{
    std::mt19937_64 random(seed);
    const auto below = [&random](std::size_t count) { return boost::random::uniform_int_distribution<std::size_t>(0, count - 1)(random); };
    Trial trial;
    trial.onset = onsets[below(onsets.size())];
    trial.axis = below(array.cluster.size());
    trial.fault = cell.fault;
    const bool signed_value = cell.fault.kind == FaultKind::bias || cell.fault.kind == FaultKind::ramp;
    if (below(2) == 1 && signed_value) trial.fault.value = -trial.fault.value;
    trial.allowed = cell.instruments ? array.cluster.axes_of(array.cluster.instrument[trial.axis]) : axis_bit(trial.axis);
    return trial;
}

Reactions summed(const std::vector<TrialResult>& results, Judged TrialResult::*method)
{
    Reactions sum;
    std::vector<double> detected;
    std::vector<double> isolated;
    for (const TrialResult& result : results) {
        const Judged& judged = result.*method;
        const bool right = judged.judgement == Judgement::right;
        sum.right += right ? 1 : 0;
        sum.wrong += judged.judgement == Judgement::wrong ? 1 : 0;
        sum.ambiguous += judged.judgement == Judgement::ambiguous ? 1 : 0;
        sum.missed += judged.judgement == Judgement::missed ? 1 : 0;
        detected.push_back(judged.detected_s());
        isolated.push_back(right ? judged.isolated_s() : std::numeric_limits<double>::infinity());
        if (right) sum.slowest_isolated_s = std::max(sum.slowest_isolated_s, judged.isolated_s());
    }
    sum.median_detected_s = median(std::move(detected));
    sum.median_isolated_s = median(isolated);
    sum.isolated_s = std::move(isolated);
    return sum;
}

CellResult summed(const std::vector<TrialResult>& results)
{
    CellResult cell;
    cell.ours = summed(results, &TrialResult::ours);
    cell.px4 = summed(results, &TrialResult::px4);
    std::vector<double> onset_errors;
    for (const TrialResult& result : results) {
        if (result.attitude_bound_rad == 0) continue;  // not compared
        onset_errors.push_back(std::abs(result.onset_error_s));
        cell.largest_attitude_error_rad = std::max(cell.largest_attitude_error_rad, result.attitude_error_rad);
        cell.beyond_bound += result.attitude_error_rad > result.attitude_bound_rad ? 1 : 0;
    }
    cell.attitudes = onset_errors.size();
    if (!onset_errors.empty()) cell.largest_onset_error_s = *std::max_element(onset_errors.begin(), onset_errors.end());
    cell.median_onset_error_s = median(std::move(onset_errors));
    return cell;
}

}  // namespace

double median(std::vector<double> values)
{
    if (values.empty()) return std::nan("");
    const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
    std::nth_element(values.begin(), middle, values.end());
    return *middle;
}

fdi::FaultMonitor accumulating(const RecordedArray& array, bool instruments, double factor)
{
    fdi::DetectorSettings settings{.method = "accumulating"};
    settings.instruments = instruments;
    settings.motion_noise = factor * array.motion_noise.value_or(1);
    settings.gated_noise = array.gated_noise;
    auto monitor = fdi::FaultMonitor::make(settings, fdi::VerdictSettings{}, array.cluster);
    assert(monitor);  // recorded arrays have three instruments or more, with noise and interval
    return std::move(*monitor);
}

fdi::FaultMonitor accumulating_with(const RecordedArray& array, bool instruments, const fdi::MotionNoise& noise)
{
    fdi::DetectorSettings settings{.method = "accumulating"};
    settings.instruments = instruments;
    auto detector = fdi::AccumulatingDetector::make(settings, array.cluster, noise);
    assert(detector);
    return fdi::FaultMonitor::make(std::move(*detector), fdi::VerdictSettings{}, array.cluster).value();
}

std::vector<Cell> violent_steps(std::size_t array, std::span<const double> sizes_deg_s)
{
    std::vector<Cell> cells;
    for (const double size : sizes_deg_s) {
        simulation::FaultSpec fault;
        fault.kind = FaultKind::bias;
        fault.value = size * std::numbers::pi / 180;
        cells.push_back({array, true, true, fmt::format("{:g} deg/s", size), fault});
    }
    return cells;
}

std::vector<CellResult> play_cells(const std::vector<RecordedArray>& arrays, const std::vector<Cell>& cells, const MonitorOf& monitor_of,
                                   const RunSettings& settings, const OnProgress& on_progress)
{
    std::vector<std::vector<std::size_t>> onsets;
    for (const Cell& cell : cells) onsets.push_back(possible_onsets(arrays[cell.array], cell.moving));
    std::vector<std::vector<TrialResult>> results(cells.size(), std::vector<TrialResult>(settings.trials));
    cli::for_each(cells.size() * settings.trials, settings.threads, on_progress, [&](std::size_t i) {
        const std::size_t number = i / settings.trials;
        const std::size_t trial = i % settings.trials;
        const Cell& cell = cells[number];
        const RecordedArray& array = arrays[cell.array];
        if (onsets[number].empty()) return;
        // The same frames, axes and signs for every size and method: what differs between cells is the fault alone.
        std::seed_seq seed{settings.seed, std::uint64_t{cell.moving}, std::uint64_t{trial}};
        results[number][trial] = play(array, drawn(array, cell, onsets[number], seed), monitor_of(array, cell.instruments));
    });
    std::vector<CellResult> sums;
    for (const auto& cell : results) sums.push_back(summed(cell));
    return sums;
}

HealthyRun play_healthy(const std::vector<RecordedArray>& arrays, std::size_t array, bool instruments, const MonitorOf& monitor_of)
{
    const RecordedArray& recording = arrays[array];
    HealthyRun run{.array = array, .instruments = instruments, .duration_s = recording.duration_s()};
    auto monitor = monitor_of(recording, instruments);
    Px4Rule px4(recording.cluster);
    for (const SensorFrame& frame : recording.frames) {
        const FaultVerdict& verdict = monitor.assess(frame);
        const auto state = state_of(verdict);
        run.ambiguous_frames += state == VerdictState::ambiguous ? 1 : 0;
        run.suspicious_frames += state == VerdictState::suspect ? 1 : 0;
        run.largest_statistic = std::max(run.largest_statistic, verdict.statistic);
        if (verdict.isolated_mask != 0) {
            ++run.false_isolations;
            monitor.readmit(verdict.isolated_mask);
        }
        if (px4.update(frame) != 0) {
            ++run.px4_isolations;
            px4 = Px4Rule(recording.cluster);
        }
    }
    return run;
}

}  // namespace quorient::studies
