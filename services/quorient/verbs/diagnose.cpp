#include "cli/json_output.hpp"
#include "cli/log_choice.hpp"
#include "cli/output_file.hpp"
#include "report/diagnosis_json.hpp"
#include "report/diagnosis_page.hpp"
#include "report/diagnosis_text.hpp"
#include "report/log_frames.hpp"
#include "verbs.hpp"

#include "quorient/diagnosis/diagnose.hpp"

#include <fmt/format.h>
#include <filesystem>
#include <memory>

namespace quorient::cli {
namespace {

struct DiagnoseOptions {
    std::vector<std::string> logs;
    std::optional<std::string> reference;
    std::string sensor_class = "consumer";
    std::optional<std::string> mount;
    LogChoice log;
    std::optional<std::string> html;
    bool force = false;
    bool json = false;
    bool check = false;
};

diagnosis::Options diagnosis_options(const DiagnoseOptions& options)
{
    diagnosis::Options chosen;
    chosen.sensor_class = *fdi::sensor_class_named(options.sensor_class);
    if (options.mount) chosen.mount = fdi::mount_named(*options.mount);
    return chosen;
}

SurveyedFrames read(const std::vector<std::string>& files, const DiagnoseOptions& options)
{
    auto frames = SurveyedFrames::read(std::vector<std::filesystem::path>(files.begin(), files.end()), options.log.options());
    if (!frames) fail(frames.error());
    return std::move(*frames);
}

void write_page(OutputFile& file, const diagnosis::Report& report)
{
    file.stream() << diagnosis_page(report);
    file.finish_document();
}

void run_diagnose(const DiagnoseOptions& options)
{
    std::vector<std::string> inputs = options.logs;
    inputs.push_back(options.reference.value_or(""));
    refuse_shared_names(inputs, {options.html.value_or("")});
    std::optional<OutputFile> page;
    if (options.html) page.emplace(*options.html, options.force);
    diagnosis::Options chosen = diagnosis_options(options);
    if (options.reference) {
        auto healthy = read({*options.reference}, options);
        auto reference = diagnosis::reference_of(healthy.survey(), healthy, chosen);
        if (!reference) fail(reference.error());
        chosen.reference = std::move(*reference);
    }
    auto frames = read(options.logs, options);
    const diagnosis::Report report = diagnosis::diagnose(frames.survey(), frames, chosen);
    if (page) write_page(*page, report);
    if (options.json) fmt::print("{}\n", dump(diagnosis_json(report)));
    else fmt::print("{}", diagnosis_text(report));
    if (options.check && report.found_anything()) throw Exit{ExitCode::not_as_asked};
}

}  // namespace

void add_diagnose(Program& program)
{
    Verb verb = program.verb("diagnose", "Says which gyro of a flight log failed, since when, and by how much.");
    const auto options = std::make_shared<DiagnoseOptions>();
    verb.arguments("log", options->logs,
                   "one log or several of the same motion: ArduPilot .bin or .log, PX4 .ulg, ROS 2 bag, CSV; compressed or not").required();
    verb.option("--reference", options->reference, "a healthy log of the same vehicle: its biases, gains and mountings are taken out first")
        .value_name("HEALTHY_LOG");
    verb.option("--class", options->sensor_class, "how much sound gyros may differ")
        .one_of({"consumer", "industrial", "tactical", "fibre-optic"})
        .shows_default();
    verb.option("--mount", options->mount, "all on one board, or separate boxes on a structure that flexes; by default several logs are boxes")
        .one_of({"board", "structure"});
    options->log.add_to(verb);
    verb.option("--html", options->html, "writes the report with diagrams as one page that needs no network").value_name("FILE");
    add_force(verb, options->force);
    verb.flag("--json", options->json, "one JSON object in place of the text");
    verb.flag("--check", options->check, "exit with 1 where something was found that did not pass by itself");
    verb.footer("Needs no system file and no converter. Axes are x, y, z of the instrument.\n"
                "Example: quorient diagnose flight.bin --html flight.html");
    verb.not_as_asked_if("--check: something was found");
    verb.run([options] { run_diagnose(*options); });
}

}  // namespace quorient::cli
