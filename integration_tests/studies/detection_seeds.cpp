#include "detection_cells.hpp"
#include "study.hpp"
#include "cli/program.hpp"

#include <fmt/format.h>
#include <algorithm>
#include <boost/random/uniform_int_distribution.hpp>
#include <cmath>
#include <random>
#include <utility>

namespace quorient::studies {

namespace {

constexpr double sizes_deg_s[] = {5, 10, 22.9};
constexpr std::uint64_t seeds = 5;
constexpr std::size_t resamples = 10'000;

std::string seconds(double value)
{
    return std::isfinite(value) ? fmt::format("{:.3f}", value) : "-";
}

/// The middle 95 % of the medians of samples that are drawn from these values, with repetition.
std::pair<double, double> bootstrap_interval(const std::vector<double>& values)
{
    std::mt19937_64 random(1);
    boost::random::uniform_int_distribution<std::size_t> place(0, values.size() - 1);
    std::vector<double> medians(resamples);
    std::vector<double> drawn(values.size());
    for (double& middle : medians) {
        for (double& value : drawn) value = values[place(random)];
        middle = median(drawn);
    }
    std::sort(medians.begin(), medians.end());
    return {medians[resamples / 40], medians[resamples - 1 - resamples / 40]};
}

/// The same cells with every seed: [seed][cell].
std::vector<std::vector<CellResult>> play_seeds(const std::vector<RecordedArray>& arrays, const std::vector<Cell>& cells,
                                                const RunSettings& settings, const OnProgress& on_progress)
{
    const MonitorOf monitor = [](const RecordedArray& array, bool instruments) { return accumulating(array, instruments); };
    std::vector<std::vector<CellResult>> results;
    for (std::uint64_t i = 0; i < seeds; ++i) {
        RunSettings run = settings;
        run.seed = settings.seed + i;
        results.push_back(play_cells(arrays, cells, monitor, run, {}));
        if (on_progress) on_progress(i + 1, seeds);
    }
    return results;
}

}  // namespace

Report detection_seeds(const RunSettings& settings, const OnProgress& on_progress)
{
    const auto arrays = load_arrays(settings.logs);
    if (!arrays) cli::fail(arrays.error());
    std::vector<Cell> cells;
    for (std::size_t array = 0; array < arrays->size(); ++array)
        for (Cell& cell : violent_steps(array, sizes_deg_s)) cells.push_back(std::move(cell));
    const auto results = play_seeds(*arrays, cells, settings, on_progress);
    Report report;
    report.text = fmt::format(
        "Steps that begin in violent motion, instruments blamed: median time to isolation in s of {} trials with each of {} seeds, of all\n"
        "together, and the middle 95 % of {} resampled medians (of these two recordings: it holds no other recording's scatter)\n\n{:<46} "
        "{:<10}",
        settings.trials, seeds, resamples, "array", "fault");
    for (std::uint64_t i = 0; i < seeds; ++i) report.text += fmt::format(" {:>7}", fmt::format("seed {}", settings.seed + i));
    report.text += fmt::format(" {:>7} {:>16} {:>7} {:>7}\n", "all", "95 %", "right", "wrong");
    for (std::size_t c = 0; c < cells.size(); ++c) {
        const std::string& name = (*arrays)[cells[c].array].name;
        report.text += fmt::format("{:<46} {:<10}", name, cells[c].fault_name);
        Json row{{"array", name}, {"fault", cells[c].fault_name}};
        std::vector<double> pooled;
        std::size_t right = 0;
        std::size_t wrong = 0;
        for (const auto& of_seed : results) {
            const Reactions& ours = of_seed[c].ours;
            pooled.insert(pooled.end(), ours.isolated_s.begin(), ours.isolated_s.end());
            right += ours.right;
            wrong += ours.wrong;
            report.text += fmt::format(" {:>7}", seconds(ours.median_isolated_s));
            row["medians_s"].push_back(std::isfinite(ours.median_isolated_s) ? Json(ours.median_isolated_s) : Json());
        }
        const auto [low, high] = bootstrap_interval(pooled);
        const double middle = median(pooled);
        report.text +=
            fmt::format(" {:>7} {:>16} {:>7} {:>7}\n", seconds(middle), fmt::format("{} .. {}", seconds(low), seconds(high)), right, wrong);
        row["pooled_median_s"] = std::isfinite(middle) ? Json(middle) : Json();
        row["interval_s"] = {std::isfinite(low) ? Json(low) : Json(), std::isfinite(high) ? Json(high) : Json()};
        row["right"] = right;
        row["wrong"] = wrong;
        report.json["rows"].push_back(std::move(row));
    }
    return report;
}

}  // namespace quorient::studies
