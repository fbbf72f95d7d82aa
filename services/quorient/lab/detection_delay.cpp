#include "detection_cells.hpp"
#include "detection_report.hpp"
#include "quorient/fdi/accumulating.hpp"
#include "study.hpp"
#include "verbs/failure.hpp"

#include <fmt/format.h>
#include <cstdlib>
#include <filesystem>
#include <numbers>
#include <numeric>

namespace quorient::lab {

namespace {

constexpr double degree = std::numbers::pi / 180;
constexpr double rest_sizes_deg_s[] = {0.5, 1, 2, 22.9, 60};
constexpr double motion_sizes_deg_s[] = {2, 5, 10, 22.9, 60};

struct Kind {
    const char* name;
    FaultKind kind;
    double value;
    double frequency_hz = 0;
};

constexpr Kind kinds[] = {
    {"ramp 1 deg/s^2", FaultKind::ramp, 1 * degree},
    {"scale 10 %", FaultKind::scale, 0.9},
    {"stuck", FaultKind::stuck, 0},
    {"zero", FaultKind::zero, 0},
    {"rail", FaultKind::rail, 0},
    {"sign", FaultKind::sign, 0},
    {"noise x10", FaultKind::noise, 10},
    {"oscillation 10 deg/s 2 Hz", FaultKind::oscillation, 10 * degree, 2},
    {"dropout 50 %", FaultKind::dropout, 0.5},
    {"delay 5 ms", FaultKind::delay, 0.005},
};

/// Every recording, calibrated by the next one: three of its instruments where it has five or more, and all.
std::vector<RecordedArray> arrays_of(const std::vector<std::filesystem::path>& logs)
{
    std::vector<Recording> recordings;
    for (const auto& log : logs) {
        auto recording = load_recording(log);
        if (!recording) cli::fail(recording.error());
        recordings.push_back(std::move(*recording));
    }
    std::vector<RecordedArray> arrays;
    for (std::size_t i = 0; i < recordings.size(); ++i) {
        const auto& calibration = recordings[(i + 1) % recordings.size()].calibration.cluster;
        std::vector<std::size_t> all(calibration.description.instrument_count);
        std::iota(all.begin(), all.end(), 0);
        std::vector<std::vector<std::size_t>> sets{all};
        if (all.size() >= 5) sets.insert(sets.begin(), {0, 2, 4});
        for (const auto& set : sets) {
            auto array = corrected(recordings[i], calibration, set);
            if (!array) cli::fail(array.error());
            arrays.push_back(std::move(*array));
        }
    }
    return arrays;
}

simulation::FaultSpec fault_of(const Kind& kind)
{
    simulation::FaultSpec fault;
    fault.kind = kind.kind;
    fault.value = kind.value;
    fault.frequency_hz = kind.frequency_hz;
    return fault;
}

std::vector<Cell> bias_cells(std::size_t arrays)
{
    std::vector<Cell> cells;
    for (const bool instruments : {true, false})
        for (const bool moving : {false, true})
            for (std::size_t array = 0; array < arrays; ++array)
                for (const double size : moving ? motion_sizes_deg_s : rest_sizes_deg_s) {
                    const Kind step{"", FaultKind::bias, size * degree};
                    cells.push_back({array, moving, instruments, fmt::format("{:g} deg/s", size), fault_of(step)});
                }
    return cells;
}

std::vector<Cell> kind_cells(std::size_t arrays)
{
    std::vector<Cell> cells;
    for (const bool moving : {false, true})
        for (std::size_t array = 0; array < arrays; ++array)
            for (const Kind& kind : kinds) cells.push_back({array, moving, true, kind.name, fault_of(kind)});
    return cells;
}

fdi::FaultMonitor accumulating(const RecordedArray& array, bool instruments)
{
    fdi::DetectorSettings settings{.method = "accumulating"};
    settings.instruments = instruments;
    auto monitor = fdi::FaultMonitor::make(settings, fdi::VerdictSettings{}, array.cluster);
    if (!monitor) cli::fail(fmt::format("{}: {}", array.name, monitor.error()));
    return std::move(*monitor);
}

}  // namespace

Report detection_delay(const RunSettings& settings, const OnProgress& on_progress)
{
    const auto arrays = arrays_of(settings.logs);
    DetectionFigures figures;
    for (const RecordedArray& array : arrays) figures.arrays.push_back(array.name);
    figures.cells = bias_cells(arrays.size());
    figures.bias_cells = figures.cells.size();
    for (Cell& cell : kind_cells(arrays.size())) figures.cells.push_back(std::move(cell));
    figures.results = play_cells(arrays, figures.cells, accumulating, settings, on_progress);
    for (std::size_t array = 0; array < arrays.size(); ++array)
        for (const bool instruments : {true, false}) figures.healthy.push_back(play_healthy(arrays, array, instruments, accumulating));
    return detection_report(figures, settings.trials);
}

}  // namespace quorient::lab
