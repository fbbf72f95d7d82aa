#include "detection_report.hpp"

#include "quorient/messages/units.hpp"

#include <fmt/format.h>
#include <cmath>
#include <iterator>

namespace quorient::studies {

namespace {

std::string seconds(double value)
{
    return std::isfinite(value) ? fmt::format("{:.3f}", value) : "-";
}

Json number(double value)
{
    return std::isfinite(value) ? Json(value) : Json(nullptr);
}

/// right, wrong, ambiguous, missed
std::string counts(const Reactions& r)
{
    return fmt::format("{:>3} {:>3} {:>3} {:>3}", r.right, r.wrong, r.ambiguous, r.missed);
}

Json json_of(const Reactions& r)
{
    return {{"right", r.right},
            {"wrong", r.wrong},
            {"ambiguous", r.ambiguous},
            {"missed", r.missed},
            {"median_detected_s", number(r.median_detected_s)},
            {"median_isolated_s", number(r.median_isolated_s)},
            {"slowest_isolated_s", r.slowest_isolated_s}};
}

Json json_of(const Cell& cell, const CellResult& result, const std::vector<std::string>& arrays)
{
    Json json{{"array", arrays[cell.array]},
              {"motion", cell.moving ? "violent" : "rest"},
              {"hypotheses", cell.instruments ? "instruments" : "axes"},
              {"fault", cell.fault_name},
              {"ours", json_of(result.ours)},
              {"px4", json_of(result.px4)}};
    if (result.attitudes > 0)
        json["attitude"] = {{"compared", result.attitudes},
                            {"median_onset_error_s", number(result.median_onset_error_s)},
                            {"largest_onset_error_s", result.largest_onset_error_s},
                            {"largest_error_deg", result.largest_attitude_error_rad / degree},
                            {"beyond_bound", result.beyond_bound}};
    return json;
}

/// Begins a new block of a table where the array, the motion or the hypotheses change.
bool continues(const Cell& cell, const Cell& before)
{
    return cell.array == before.array && cell.moving == before.moving && cell.instruments == before.instruments;
}

std::string heading(const Cell& cell, const std::vector<std::string>& arrays)
{
    return fmt::format("\n{}, {}, {} blamed\n", arrays[cell.array], cell.moving ? "violent motion" : "at rest",
                       cell.instruments ? "instruments" : "axes");
}

void add_bias_cells(const DetectionFigures& figures, std::string& text)
{
    const auto out = std::back_inserter(text);
    fmt::format_to(out,
                   "Bias steps. Counts: right, wrong, ambiguous, missed; times in s, medians over all trials; onset: |error| median, "
                   "largest; attitude: largest error after roll-back, how many beyond 0.1 deg + weight x fault x onset error\n"
                   "{:<12}|{:^50}|{:^28}|\n{:<12}|{:>16}{:>9}{:>9}{:>7}{:>7}  |{:>16}{:>10}  |{:>10} deg\n",
                   "", "ours", "PX4 rule", "fault", "counts", "isolated", "slowest", "onset", "", "counts", "isolated", "attitude");
    for (std::size_t i = 0; i < figures.bias_cells; ++i) {
        const Cell& cell = figures.cells[i];
        const CellResult& r = figures.results[i];
        if (i == 0 || !continues(cell, figures.cells[i - 1])) text += heading(cell, figures.arrays);
        fmt::format_to(out, "{:<12}| {}{:>9}{:>9}{:>7}{:>7}  | {}{:>10}  |{:>10.4f}{:>4}\n", cell.fault_name, counts(r.ours),
                       seconds(r.ours.median_isolated_s), seconds(r.ours.slowest_isolated_s), seconds(r.median_onset_error_s),
                       seconds(r.largest_onset_error_s), counts(r.px4), seconds(r.px4.median_isolated_s),
                       r.largest_attitude_error_rad / degree, r.beyond_bound);
    }
}

void add_kinds(const DetectionFigures& figures, std::string& text)
{
    const auto out = std::back_inserter(text);
    fmt::format_to(out,
                   "\nKinds of faults. As above; detected: the first frame that is not healthy\n{:<28}|{:>16}{:>10}{:>10}  |{:>16}{:>10}\n",
                   "fault", "ours", "detected", "isolated", "PX4 rule", "isolated");
    for (std::size_t i = figures.bias_cells; i < figures.cells.size(); ++i) {
        const Cell& cell = figures.cells[i];
        const CellResult& r = figures.results[i];
        if (i == figures.bias_cells || !continues(cell, figures.cells[i - 1])) text += heading(cell, figures.arrays);
        fmt::format_to(out, "{:<28}| {}{:>10}{:>10}  | {}{:>10}\n", cell.fault_name, counts(r.ours), seconds(r.ours.median_detected_s),
                       seconds(r.ours.median_isolated_s), counts(r.px4), seconds(r.px4.median_isolated_s));
    }
}

void add_healthy(const DetectionFigures& figures, std::string& text)
{
    const auto out = std::back_inserter(text);
    fmt::format_to(out, "\nWithout a fault, the whole recordings\n{:<48}{:>12}{:>8}{:>17}{:>11}{:>10}{:>11}{:>6}\n", "array", "hypotheses",
                   "s", "false isolations", "ambiguous", "suspect", "statistic", "PX4");
    for (const HealthyRun& run : figures.healthy)
        fmt::format_to(out, "{:<48}{:>12}{:>8.1f}{:>17}{:>11}{:>10}{:>11.2f}{:>6}\n", figures.arrays[run.array],
                       run.instruments ? "instruments" : "axes", run.duration_s, run.false_isolations, run.ambiguous_frames,
                       run.suspicious_frames, run.largest_statistic, run.px4_isolations);
}

void add_exclusion_costs(const DetectionFigures& figures, std::string& text)
{
    const auto out = std::back_inserter(text);
    fmt::format_to(
        out,
        "\nWhat it costs to leave a sound instrument out of some frames of violent motion: how far the attitude turns away, deg\n"
        "{:<48}{:>8}{:>10}{:>10}{:>20}\n",
        "array", "frames", "median", "90 %", "above 0.1 deg, %");
    for (const ExclusionCost& cost : figures.exclusion_costs)
        fmt::format_to(out, "{:<48}{:>8}{:>10.3f}{:>10.3f}{:>20.1f}\n", figures.arrays[cost.array], cost.frames, cost.median_rad / degree,
                       cost.ninth_decile_rad / degree, 100 * cost.share_above_free);
}

}  // namespace

Report detection_report(const DetectionFigures& figures, std::uint64_t trials)
{
    Report report;
    report.text = fmt::format(
        "Faults added to real recordings: {} random beginnings, axes and signs per row; horizon {} s. Every recording is corrected by the\n"
        "calibration of another one.\n\n",
        trials, horizon_s);
    add_bias_cells(figures, report.text);
    add_kinds(figures, report.text);
    add_healthy(figures, report.text);
    add_exclusion_costs(figures, report.text);
    for (std::size_t i = 0; i < figures.cells.size(); ++i)
        report.json[i < figures.bias_cells ? "bias" : "kinds"].push_back(json_of(figures.cells[i], figures.results[i], figures.arrays));
    for (const HealthyRun& run : figures.healthy)
        report.json["healthy"].push_back({{"array", figures.arrays[run.array]},
                                          {"hypotheses", run.instruments ? "instruments" : "axes"},
                                          {"duration_s", run.duration_s},
                                          {"false_isolations", run.false_isolations},
                                          {"ambiguous_frames", run.ambiguous_frames},
                                          {"suspicious_frames", run.suspicious_frames},
                                          {"largest_statistic", run.largest_statistic},
                                          {"px4_isolations", run.px4_isolations}});
    for (const ExclusionCost& cost : figures.exclusion_costs)
        report.json["exclusion_cost"].push_back({{"array", figures.arrays[cost.array]},
                                                 {"frames", cost.frames},
                                                 {"median_rad", cost.median_rad},
                                                 {"ninth_decile_rad", cost.ninth_decile_rad},
                                                 {"share_above_free", cost.share_above_free}});
    return report;
}

}  // namespace quorient::studies
