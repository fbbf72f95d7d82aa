#include "detection_cells.hpp"
#include "study.hpp"
#include "cli/program.hpp"

#include <fmt/format.h>
#include <cmath>

namespace quorient::studies {

namespace {

constexpr double factors[] = {0.5, 0.7, 0.85, 1, 1.2, 1.4, 2};
constexpr double sizes_deg_s[] = {5, 10, 22.9};

std::string seconds(double value)
{
    return std::isfinite(value) ? fmt::format("{:.3f}", value) : "-";
}

}  // namespace

Report motion_noise(const RunSettings& settings, const OnProgress& on_progress)
{
    const auto arrays = load_arrays(settings.logs);
    if (!arrays) cli::fail(arrays.error());
    Report report;
    report.text = fmt::format(
        "The motion noise that the other recording shows (level: times the usual), and what becomes of it when it is wrong by a factor.\n"
        "Largest statistic (1 = suspicious) and false isolations over the whole recording without a fault; then steps that begin in "
        "violent\n"
        "motion, {} each: median time to isolation in s (right wrong)\n\n{:<44} {:>5} {:>6} {:>9} {:>6}",
        settings.trials, "array", "level", "factor", "statistic", "false");
    for (const double size : sizes_deg_s) report.text += fmt::format(" {:>20}", fmt::format("{:g} deg/s", size));
    report.text += '\n';
    const std::size_t rows = arrays->size() * std::size(factors);
    std::size_t done = 0;
    for (std::size_t array = 0; array < arrays->size(); ++array)
        for (const double factor : factors) {
            const MonitorOf monitor = [factor](const RecordedArray& watched, bool instruments) {
                return accumulating(watched, instruments, factor);
            };
            const HealthyRun healthy = play_healthy(*arrays, array, true, monitor);
            const auto cells = violent_steps(array, sizes_deg_s);
            const auto results = play_cells(*arrays, cells, monitor, settings, {});
            const double level = (*arrays)[array].motion_noise.value_or(1);
            Json row{{"array", (*arrays)[array].name},
                     {"level", level},
                     {"factor", factor},
                     {"largest_statistic", healthy.largest_statistic},
                     {"false_isolations", healthy.false_isolations}};
            report.text += fmt::format("{:<44} {:>5.2f} {:>6.2f} {:>9.2f} {:>6}", (*arrays)[array].name, level, factor,
                                       healthy.largest_statistic, healthy.false_isolations);
            for (std::size_t i = 0; i < cells.size(); ++i) {
                const Reactions& ours = results[i].ours;
                report.text += fmt::format(" {:>20}", fmt::format("{} ({} {})", seconds(ours.median_isolated_s), ours.right, ours.wrong));
                row["steps"].push_back(
                    {{"fault", cells[i].fault_name},
                     {"median_isolated_s", std::isfinite(ours.median_isolated_s) ? Json(ours.median_isolated_s) : Json()},
                     {"right", ours.right},
                     {"wrong", ours.wrong}});
            }
            report.text += '\n';
            report.json["rows"].push_back(std::move(row));
            if (on_progress) on_progress(++done, rows);
        }
    return report;
}

}  // namespace quorient::studies
