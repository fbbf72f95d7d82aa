#include "detection_cells.hpp"
#include "detection_report.hpp"
#include "arrays/accumulating_detector.hpp"
#include "quorient/messages/meaning.hpp"
#include "quorient/messages/units.hpp"
#include "study.hpp"
#include "cli/program.hpp"

#include <fmt/format.h>
#include <cstdlib>
#include <filesystem>

namespace quorient::studies {

namespace {

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

}  // namespace

Report detection_delay(const RunSettings& settings, const OnProgress& on_progress)
{
    const auto loaded = load_arrays(settings.logs);
    if (!loaded) cli::fail(loaded.error());
    const auto& arrays = *loaded;
    const MonitorOf monitor = [](const RecordedArray& array, bool instruments) { return accumulating(array, instruments); };
    DetectionFigures figures;
    for (const RecordedArray& array : arrays) figures.arrays.push_back(array.name);
    figures.cells = bias_cells(arrays.size());
    figures.bias_cells = figures.cells.size();
    for (Cell& cell : kind_cells(arrays.size())) figures.cells.push_back(std::move(cell));
    figures.results = play_cells(arrays, figures.cells, monitor, settings, on_progress);
    for (std::size_t array = 0; array < arrays.size(); ++array)
        for (const bool instruments : {true, false}) figures.healthy.push_back(play_healthy(arrays, array, instruments, monitor));
    figures.exclusion_costs = exclusion_costs(arrays);
    return detection_report(figures, settings.trials);
}

}  // namespace quorient::studies
