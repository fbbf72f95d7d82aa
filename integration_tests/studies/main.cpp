#include "cli/json_output.hpp"
#include "cli/output_file.hpp"
#include "cli/program.hpp"
#include "cli/progress.hpp"
#include "data_folder.hpp"
#include "quorient/runtime/log.hpp"
#include "study.hpp"

#include <fmt/format.h>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace quorient::studies {
namespace {

struct Study {
    const char* name;
    const char* description;
    std::uint64_t trials;  ///< default, per scene
    Report (*run)(const RunSettings&, const OnProgress&);
    enum class Logs { none, of_one_array, any } logs = Logs::none;
};

/// The one list of studies.
constexpr Study all_studies[] = {
    {"isolation", "methods x layouts x 0, 1, 2 faults, and the subset method over its margin", isolation_trials, isolation},
    {"paper-002", "the figures of the paper that a fitted fault model reproduces", paper_002_trials, paper_002},
    {"ceiling", "what a single sample can detect and isolate, per layout", ceiling_trials, ceiling},
    {"vessel", "observers on the vessel of paper 001: false alarms and isolation with a model that is 5 % wrong", vessel_trials, vessel},
    {"design", "the layout designer: known optima, published arrays, every choice of places, survival of families", array_design_trials,
     array_design},
    {"detection-delay", "faults added to two recordings of one array, each corrected by the other's calibration", detection_delay_trials,
     detection_delay, Study::Logs::of_one_array},
    {"detection-seeds", "the same steps in violent motion with five seeds: how much the medians scatter", detection_seeds_trials,
     detection_seeds, Study::Logs::of_one_array},
    {"motion-noise", "the same steps in violent motion, with the detector's motion noise wrong by factors of 0.5 to 2", motion_noise_trials,
     motion_noise, Study::Logs::of_one_array},
    {"motion-terms", "the terms of that noise from each recording alone, and the other one played with them", motion_terms_trials,
     motion_terms, Study::Logs::of_one_array},
    {"field", "the field detector on logs of any arrays, uncalibrated: as they are, and with faults added", field_trials, field,
     Study::Logs::any},
    {"field-ablation", "the same with one rule of the detector off at a time", field_ablation_trials, field_ablation, Study::Logs::any},
};

struct Options {
    std::optional<std::uint64_t> trials;
    std::uint64_t seed = 1;
    unsigned threads = 0;
    std::string plot;
    bool force = false;
    std::vector<std::string> logs;
    std::vector<std::string> faulty_logs;
    bool structure = false;
    bool json = false;
};

/// The recordings that the user names, or the two of one array that the data folder holds.
std::vector<std::filesystem::path> logs_of(const Study& study, const Options& options)
{
    if (study.logs == Study::Logs::none) return {};
    if (study.logs == Study::Logs::any) {
        if (options.logs.empty() && options.faulty_logs.empty()) cli::fail("--log: name one log or more");
        return {options.logs.begin(), options.logs.end()};
    }
    if (options.logs.size() == 1)
        cli::fail("--log: two or more recordings of the same sensors are needed: each is calibrated by another one");
    if (!options.logs.empty()) return {options.logs.begin(), options.logs.end()};
    const auto folder = recording::data_folder("") / "mimu4444_carlsson";
    return {folder / "exp_1/data.bin", folder / "exp_2/data.bin"};
}

void run(const Study& study, const Options& options)
{
    std::optional<cli::OutputFile> plot;
    if (!options.plot.empty()) plot.emplace(options.plot, options.force);
    const RunSettings settings{options.trials.value_or(study.trials), options.seed, options.threads, logs_of(study, options),
                               {options.faulty_logs.begin(), options.faulty_logs.end()},
                               options.structure ? fdi::Mount::structure : fdi::Mount::board};
    const Report report = [&] {
        cli::Progress progress;
        return study.run(settings, [&progress](std::size_t done, std::size_t all) { progress.show(done, all); });
    }();
    if (plot) cli::write_svg(*plot, report.charts);
    if (!options.json) {
        fmt::print("{}\n{} trials per scene, seed {}\n", report.text, settings.trials, settings.seed);
        return;
    }
    Json json{{"study", study.name}, {"trials", settings.trials}, {"seed", settings.seed}};
    json.update(report.json);
    fmt::print("{}\n", cli::dump(json));
}

void add(cli::Program& program, const Study& study)
{
    auto verb = program.verb(study.name, study.description);
    const auto options = std::make_shared<Options>();
    verb.option("--trials", options->trials, "of each scene (default: what takes some seconds)").within({.lowest = 1, .highest = 1e9});
    verb.option("--seed", options->seed, "of the random numbers").shows_default();
    verb.option("--threads", options->threads, "0 = one per core").within({.lowest = 0, .highest = 1024}).shows_default();
    verb.option("--plot", options->plot, "writes the charts to this SVG file");
    cli::add_force(verb, options->force);
    if (study.logs == Study::Logs::of_one_array)
        verb.option("--log", options->logs, "one recording; repeat it (default: the two in QUORIENT_DATA_DIR or ../shared/data)");
    if (study.logs == Study::Logs::any) {
        verb.option("--log", options->logs, "one log of sound instruments; repeat it");
        verb.option("--faulty", options->faulty_logs, "one log with a real fault; repeat it");
        verb.flag("--structure", options->structure, "the instruments are separate boxes on a frame that flexes (mount: structure)");
    }
    verb.flag("--json", options->json, "one line of JSON, 17 significant digits");
    verb.run([&study, options] { run(study, *options); });
}

int run_program(int argc, char** argv)
{
    cli::Program program{"quorient-studies", "What the methods can do, by Monte Carlo and on recordings, beside the published figures."};
    program.footer(
        "The result depends on trials and seed, not on the number of threads.\n\n"
        "Example: every method on the dodecahedron and the cone, with a plot\n"
        "  quorient-studies isolation --trials 100000 --seed 1 --plot isolation.svg\n");
    for (const Study& study : all_studies) add(program, study);
    return program.run({argv + 1, argv + argc});
}

}  // namespace
}  // namespace quorient::studies

int main(int argc, char** argv)
{
    return quorient::runtime::guarded(quorient::studies::run_program, argc, argv);
}
