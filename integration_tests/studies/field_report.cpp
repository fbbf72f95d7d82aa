#include "field_report.hpp"

#include "quorient/messages/diagnosis_text.hpp"
#include "quorient/messages/units.hpp"
#include "quorient/messages/words.hpp"

#include <fmt/format.h>
#include <algorithm>
#include <bit>
#include <cmath>
#include <iterator>

namespace quorient::studies {
namespace {

std::string seconds(double value)
{
    return std::isfinite(value) ? fmt::format("{:.2f}", value) : "-";
}

void add_logs(const std::vector<LogFigures>& logs, Report& report, Json& json)
{
    fmt::format_to(std::back_inserter(report.text),
                   "| log | instruments | s | latched | left out (time) | saturated s | degraded s | PX4's rule | diagnosis at the end |\n"
                   "|--|--|--|--|--|--|--|--|--|\n");
    for (const LogFigures& log : logs) {
        const SoundRun& run = log.run;
        const std::string names =
            run.latched == 0 ? "-" : fmt::format("{} at {:.2f} s", axis_names(log.description, run.latched), run.first_latched_s);
        const std::string px4 = run.px4 == 0 ? "-" : fmt::format("{} at {:.2f} s", axis_names(log.description, run.px4), run.px4_s);
        const std::string text = diagnoses_text(run.diagnosis, log.description, ~AxisMask{0});
        fmt::format_to(std::back_inserter(report.text), "| {} | {} | {:.1f} | {} | {} ({:.2f} %) | {:.2f} | {:.1f} | {} | {} |\n", log.name,
                       log.instruments, log.duration_s, names, run.provisional_times, 100 * run.provisional_s / log.duration_s,
                       run.saturated_s, run.degraded_s, px4, text);
        json.push_back({{"log", log.name},
                        {"instruments", log.instruments},
                        {"duration_s", log.duration_s},
                        {"latched_axes", run.latched},
                        {"first_latched_s", run.latched == 0 ? Json(nullptr) : Json(run.first_latched_s)},
                        {"left_out_times", run.provisional_times},
                        {"left_out_s", run.provisional_s},
                        {"saturated_s", run.saturated_s},
                        {"degraded_s", run.degraded_s},
                        {"px4_axes", run.px4},
                        {"diagnosis", text}});
    }
}

void add_totals(const std::vector<LogFigures>& logs, Report& report)
{
    double all_s = 0;
    double out_s = 0;
    std::size_t blamed = 0;
    for (const LogFigures& log : logs) {
        all_s += log.duration_s;
        out_s += log.run.provisional_s;
        blamed += log.run.latched != 0 ? 1 : 0;
    }
    if (all_s > 0)
        fmt::format_to(std::back_inserter(report.text), "\nlatched in {} of {}; left out {:.2f} % of {:.0f} s\n", blamed, logs.size(),
                       100 * out_s / all_s, all_s);
}

void add_fault(const FaultFigures& figures, Report& report, Json& json)
{
    const FieldFault& fault = figures.fault;
    const double right = percent(figures, [&](const FaultRun& run) { return run.wrong == 0 && latched(run) != fault.passes; });
    const double wrong = percent(figures, [](const FaultRun& run) { return run.wrong != 0; });
    const double protects = percent(figures, [](const FaultRun& run) { return std::isfinite(run.protected_s); });
    const double axis = percent(figures, [](const FaultRun& run) { return run.named_axis; });
    const double kind = percent(figures, [](const FaultRun& run) { return run.named_kind; });
    const auto protected_s = each(figures, [](const FaultRun& run) { return run.protected_s; });
    const auto latched_s = each(figures, [](const FaultRun& run) { return run.latched_s; });
    const auto size = each(figures, [](const FaultRun& run) { return run.size_error.value_or(FaultRun::never_s); });
    const auto error = each(figures, [](const FaultRun& run) { return run.attitude.at_end_rad / degree; });
    const double size_unit = fault.kind == Diagnosis::bias ? degree : 1;
    fmt::format_to(std::back_inserter(report.text),
                   "| {} | {} | {:.0f} | {:.1f} | {:.0f} | {} | {} | {} | {} | {:.0f} | {:.0f} | {} | {:.2f} | {:.2f} |\n",
                   fault.name, figures.runs.size(), right, wrong, protects, seconds(quantile(protected_s, 0.5)),
                   seconds(quantile(protected_s, 0.9)), seconds(quantile(latched_s, 0.5)), seconds(quantile(latched_s, 0.9)), axis, kind,
                   seconds(quantile(size, 0.5) / size_unit), quantile(error, 0.5), quantile(error, 0.9));
    const auto or_null = [](double value) { return std::isfinite(value) ? Json(value) : Json(nullptr); };
    json.push_back({{"fault", fault.name},
                    {"trials", figures.runs.size()},
                    {"right_is_to_latch", !fault.passes},
                    {"right_percent", right},
                    {"wrong_percent", wrong},
                    {"protected_percent", protects},
                    {"protected_s", {{"median", or_null(quantile(protected_s, 0.5))}, {"p90", or_null(quantile(protected_s, 0.9))}}},
                    {"latched_s", {{"median", or_null(quantile(latched_s, 0.5))}, {"p90", or_null(quantile(latched_s, 0.9))}}},
                    {"axis_percent", axis},
                    {"kind_percent", kind},
                    {"attitude_error_deg", {{"median", quantile(error, 0.5)}, {"p90", quantile(error, 0.9)}}}});
}

/// Quantiles of the errors of an attitude [deg].
struct ErrorFigures {
    double largest, largest_p90, at_end;

    template <class Attitude>
    ErrorFigures(const FaultFigures& figures, Attitude attitude)
    {
        const auto most = each(figures, [&](const FaultRun& run) { return attitude(run).largest_rad / degree; });
        largest = quantile(most, 0.5);
        largest_p90 = quantile(most, 0.9);
        at_end = quantile(each(figures, [&](const FaultRun& run) { return attitude(run).at_end_rad / degree; }), 0.5);
    }

    std::string text() const { return fmt::format("{:.1f} | {:.1f} | {:.1f}", largest, largest_p90, at_end); }
    Json json() const { return {{"largest_median", largest}, {"largest_p90", largest_p90}, {"at_end_median", at_end}}; }
};

void add_beside_peers(const FaultFigures& figures, Report& report, Json& json)
{
    const double right = percent(figures, [](const FaultRun& run) { return std::isfinite(run.px4.named_s) && !run.px4.wrong; });
    const double wrong = percent(figures, [](const FaultRun& run) { return run.px4.wrong; });
    const double after_s = quantile(each(figures, [](const FaultRun& run) { return run.px4.wrong ? FaultRun::never_s : run.px4.named_s; }), 0.5);
    const double refuses = percent(figures, [](const FaultRun& run) { return run.ardupilot.refuses; });
    const ErrorFigures ours(figures, [](const FaultRun& run) { return run.attitude; });
    const ErrorFigures px4(figures, [](const FaultRun& run) { return run.px4.attitude; });
    const ErrorFigures ardupilot(figures, [](const FaultRun& run) { return run.ardupilot.attitude; });
    fmt::format_to(std::back_inserter(report.text), "| {} | {} | {:.0f} | {:.1f} | {} | {} | {:.0f} | {} |\n", figures.fault.name, ours.text(),
                   right, wrong, seconds(after_s), px4.text(), refuses, ardupilot.text());
    json.push_back({{"fault", figures.fault.name},
                    {"quorient", {{"attitude_error_deg", ours.json()}}},
                    {"px4",
                     {{"right_percent", right},
                      {"wrong_percent", wrong},
                      {"median_s", std::isfinite(after_s) ? Json(after_s) : Json(nullptr)},
                      {"attitude_error_deg", px4.json()}}},
                    {"ardupilot", {{"refuses_to_arm_percent", refuses}, {"attitude_error_deg", ardupilot.json()}}}});
}

void add_peers(const FieldFigures& figures, Report& report)
{
    report.text +=
        "\n## Beside the rules of PX4 and ArduPilot\n\n"
        "Errors of the attitude in the 20 s after the onset, in degrees: the largest (median, p90 of the trials), and at the end (median). "
        "PX4 and ArduPilot fly by the faulty gyro. PX4 changes to a sound one when its rule names it. ArduPilot compares gyros before "
        "arming only, in logs that begin at rest.\n\n"
        "| fault | Quorient largest | p90 | end | PX4 right % | wrong % | s | largest | p90 | end | ArduPilot refuses to arm % | largest | p90 | end |\n"
        "|--|--|--|--|--|--|--|--|--|--|--|--|--|--|\n";
    Json list = Json::array();
    for (const FaultFigures& fault : figures.faults) add_beside_peers(fault, report, list);
    report.json["beside_peers"] = list;
}

/// What was latched in place of the faulty instrument, and why.
void add_wrong(const FaultRun& run, Report& report)
{
    if (run.wrong == 0) return;
    std::string why;
    for (std::size_t axis = 0; axis < max_axes; ++axis) {
        const std::string text = diagnosis_text(run.diagnosis, axis);
        if (!text.empty()) why += fmt::format("; axis {}: {}", axis, text);
    }
    fmt::format_to(std::back_inserter(report.text), "- {}: {} latched after {:.2f} s{}\n", run.injected, axis_numbers(run.wrong), run.wrong_s, why);
}

void add_faults(const FieldFigures& figures, Report& report)
{
    report.text +=
        "\n## Faults added to the sound logs\n\n"
        "Right: the faulty instrument latched and no other; of shocks, dropouts and single spikes: nobody latched. Out: left out of the attitude.\n\n"
        "| fault | n | right % | wrong % | out % | out s | p90 | latched s | p90 | axis % | kind % | size off by | attitude deg | p90 |\n"
        "|--|--|--|--|--|--|--|--|--|--|--|--|--|--|\n";
    Json list = Json::array();
    std::size_t trials = 0;
    std::size_t wrong = 0;
    for (const FaultFigures& fault : figures.faults) {
        add_fault(fault, report, list);
        trials += fault.runs.size();
        wrong += static_cast<std::size_t>(std::ranges::count_if(fault.runs, [](const FaultRun& run) { return run.wrong != 0; }));
    }
    fmt::format_to(std::back_inserter(report.text), "\nwrong: {} of {}\n", wrong, trials);
    for (const FaultFigures& fault : figures.faults)
        for (const FaultRun& run : fault.runs) add_wrong(run, report);
    report.json["faults"] = list;
    report.json["wrong"] = wrong;
    add_peers(figures, report);
}

}  // namespace

Report field_report(const FieldFigures& figures)
{
    Report report;
    report.json["mount"] = fdi::name_of(figures.mount);
    report.text = fmt::format("mount: {}; no log is calibrated\n\n## Sound logs\n\n", fdi::name_of(figures.mount));
    Json sound = Json::array();
    add_logs(figures.sound, report, sound);
    add_totals(figures.sound, report);
    report.json["sound"] = sound;
    if (!figures.faulty.empty()) {
        report.text += "\n## Logs with a real fault\n\n";
        Json faulty = Json::array();
        add_logs(figures.faulty, report, faulty);
        report.json["faulty"] = faulty;
    }
    if (!figures.faults.empty()) add_faults(figures, report);
    return report;
}

}  // namespace quorient::studies
