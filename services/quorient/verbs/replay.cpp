#include "replay/offline.hpp"
#include "replay/transcripts.hpp"
#include "report/replay_report.hpp"
#include "report/run_picture.hpp"
#include "report/summary.hpp"
#include "report/undecided.hpp"
#include "quorient/evaluation/run_observer.hpp"
#include "cli/json_output.hpp"
#include "cli/log_choice.hpp"
#include "cli/output_file.hpp"
#include "cli/system_options.hpp"
#include "verbs.hpp"

#include <fmt/format.h>
#include <algorithm>
#include <filesystem>
#include <memory>

namespace quorient::cli {

namespace {

struct ReplayOptions {
    SystemOptions system;
    std::vector<std::string> logs;
    LogChoice choice;
    std::optional<double> from_s;
    std::optional<double> to_s;
    std::string plot;
    std::optional<std::string> events;
    std::optional<std::string> verdicts;
    bool force = false;
    bool json = false;
};

Json report_json(const evaluation::RunObserver& run, const report::ReplayReport& report, const replay::Offline& offline)
{
    const auto& errors = run.voted().errors;
    Json json;
    json["frames"] = run.truth_frames();
    json["log"] = offline.remarks();
    json["rejected"] = {{"axes_and_frames", offline.intake().rejected}, {"gaps", offline.intake().gaps}};
    json["faults"] = report.faults();
    json["isolations"] = report.isolations();
    json["false_isolations"] = report.false_isolations();
    json["undecided_s"] = report::undecided_s_json(run);
    json["undecided"] = report::undecided_json(run);
    auto& attitude = json["attitude"];
    attitude = {{"final", nullptr}, {"max_error_rad", nullptr}, {"final_error_rad", nullptr}};
    if (report.final_attitude()) attitude["final"] = report.final_attitude()->attitude;
    if (errors.compared > 0) {
        attitude["max_error_rad"] = errors.largest_rad;
        attitude["final_error_rad"] = errors.final_rad;
    }
    return json;
}

void print_table(const Json& json, const evaluation::RunObserver& run)
{
    fmt::print("frames {}\nlog {}\n", json["frames"].get<std::uint64_t>(), json["log"].get<std::string>());
    for (const auto& fault : json["faults"]) {
        fmt::print("{}\n", fault["spec"].get<std::string>());
        if (!fault.contains("lanes")) continue;
        for (const auto& [lane, reaction] : fault["lanes"].items())
            fmt::print("  lane {:<8} detected {:<10} isolated {:<10} axes {}\n", lane, dump(reaction["detected_s"]),
                       dump(reaction["isolated_s"]), dump(reaction["isolated"]));
    }
    for (const auto& entry : json["isolations"])
        fmt::print("lane {} isolated: {} from {:.3f} s{}{}\n", entry["lane"].get<std::string>(), entry["names"].get<std::string>(),
                   entry["time_s"].get<double>(), entry["diagnosis"].get<std::string>().empty() ? "" : "; ", entry["diagnosis"].get<std::string>());
    if (json["isolations"].empty()) fmt::print("isolated: nothing\n");
    if (!json["faults"].empty()) fmt::print("false isolations {}, against the faults stated above\n", json["false_isolations"].size());
    fmt::print("{}", report::undecided_text(run));
    fmt::print("final attitude {}, largest error {}, final error {} rad\n", dump(json["attitude"]["final"]),
               dump(json["attitude"]["max_error_rad"]), dump(json["attitude"]["final_error_rad"]));
}

/// A list of file names as YAML; absolute, since those of a system file count from its folder.
std::string quoted(const std::vector<std::string>& logs)
{
    std::string list;
    for (const auto& log : logs) {
        std::string name;
        for (const char character : std::filesystem::absolute(log).string())
            name += character == '\'' ? std::string("''") : std::string(1, character);
        list += fmt::format("{}'{}'", list.empty() ? "" : ",", name);
    }
    return fmt::format("[{}]", list);
}

/// A file that injects faults expects them. A replay leaves those faults out, and so the expectations, too, unless the user states a fault
/// or an expectation.
bool leaves_expectations_out(const SystemOptions& options)
{
    if (!options.faults.empty()) return false;
    if (std::ranges::any_of(options.set, [](const std::string& assignment) { return assignment.starts_with("expect"); })) return false;
    const auto as_it_stands = system::load(options.file, options.overrides(false));
    return as_it_stands && !as_it_stands->sensor.source.scenario.faults.empty();
}

int replay(ReplayOptions options)
{
    refuse_shared_names(options.logs, {options.events.value_or(""), options.verdicts.value_or(""), options.plot});
    if (leaves_expectations_out(options.system)) options.system.set.push_back("expect=null");
    if (options.from_s && options.to_s && !(*options.from_s < *options.to_s))
        fail(fmt::format("--from {} is not before --to {}", *options.from_s, *options.to_s));
    options.system.set.push_back("source.kind=log");
    options.system.set.push_back("source.faults=[]");  // the log is what it is; only --fault adds to it
    options.system.set.push_back("source.file=" + quoted(options.logs));
    if (options.from_s) options.system.set.push_back(fmt::format("source.from_s={}", *options.from_s));
    if (options.to_s) options.system.set.push_back(fmt::format("source.to_s={}", *options.to_s));
    const auto system = options.system.load_without_joining();
    std::optional<OutputFile> picture;
    if (!options.plot.empty()) picture.emplace(options.plot, options.force);

    evaluation::RunObserver run{system, evaluation::Shadow::off};
    report::ReplayReport report{system};
    std::optional<report::RunTimeline> timeline;
    if (picture) timeline.emplace(system, run);
    std::optional<OutputFile> events;
    std::optional<OutputFile> verdicts;
    if (options.events) events.emplace(*options.events, options.force);
    if (options.verdicts) verdicts.emplace(*options.verdicts, options.force);
    replay::Offline offline{system, run, report, options.choice.options(), timeline ? &*timeline : nullptr};
    if (events) replay::write_events(offline, *events);
    if (verdicts) replay::write_verdicts(offline, system, *verdicts);
    if (const auto done = offline.run(); !done) {
        fail(done.error());
    }
    if (run.truth_frames() == 0) fail(fmt::format("no frame to replay: {}", offline.remarks()));
    for (auto* const file : {&events, &verdicts})
        if (*file) (*file)->finish_rows();
    const auto failures = report::unmet(system, run);
    auto json = report_json(run, report, offline);
    json["unmet"] = failures;
    if (options.json) fmt::print("{}\n", dump(json));
    else print_table(json, run);
    if (picture) {
        picture->stream() << report::run_picture(system, run, *timeline);
        picture->finish_document();
    }
    for (const auto& failure : failures) fmt::print(stderr, "not as expected: {}\n", failure);
    if (!failures.empty()) fmt::print(stderr, "the expectations are those of {}; --set expect=null leaves them out\n", options.system.file);
    return failures.empty() ? ExitCode::done : ExitCode::not_as_asked;
}

}  // namespace

void add_replay(Program& program)
{
    auto verb = program.verb(
        "replay", "The whole system over a recording on the local bus, as fast as it goes; bit-identical on every run");
    auto options = std::make_shared<ReplayOptions>();
    verb.arguments("log", options->logs,
                     "any log of gyros: ArduPilot, PX4, ROS 2 bag, CSV, MIMU4444, Xsens DOT; several of one motion are merged")
        .required()
        .value_name("LOG ...");
    options->system.add_replay_to(verb);
    options->choice.add_to(verb);
    verb.option("--from", options->from_s, "Begin here").within(settings::not_negative).value_name("S");
    verb.option("--to", options->to_s, "End here").within(settings::above_zero).value_name("S");
    verb.option("--plot", options->plot, "Draw the run over time: attitude, residuals, axes left out, level").value_name("FILE.svg");
    verb.option("--events", options->events, "Writes what the processes reported, one JSON object a line").value_name("FILE");
    verb.option("--verdicts", options->verdicts, "Writes the verdict of each lane and frame as a CSV").value_name("FILE");
    add_force(verb, options->force);
    verb.flag("--json", options->json, "One JSON object");
    verb.not_as_asked_if("the file's `expect` is not met");
    verb.footer(
        "Example:\n  quorient replay data.bin --system deploy/configurations/mimu4444.yaml --fault axis=7,kind=bias,value=1,start=14 --to 22 --json");
    verb.run([options] {
        if (const int exit_code = replay(*options); exit_code != 0) throw Exit{exit_code};
    });
}

}  // namespace quorient::cli
