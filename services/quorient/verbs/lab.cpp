#include "lab/progress.hpp"
#include "lab/study.hpp"

#include "failure.hpp"
#include "json_output.hpp"
#include "verbs.hpp"

#include <fmt/format.h>
#include <cstdlib>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace quorient::cli {

namespace {

struct Study {
    const char* name;
    std::uint64_t trials;  ///< default, per scene
    lab::Report (*run)(const lab::RunSettings&, const lab::OnProgress&);
    bool recorded = false;  ///< plays recordings
};

constexpr Study studies[] = {
    {"isolation", lab::isolation_trials, lab::isolation},
    {"paper-002", lab::paper_002_trials, lab::paper_002},
    {"ceiling", lab::ceiling_trials, lab::ceiling},
    {"vessel", lab::vessel_trials, lab::vessel},
    {"detection-delay", lab::detection_delay_trials, lab::detection_delay, true},
    {"detection-seeds", lab::detection_seeds_trials, lab::detection_seeds, true},
    {"motion-noise", lab::motion_noise_trials, lab::motion_noise, true},
    {"motion-terms", lab::motion_terms_trials, lab::motion_terms, true},
};

struct LabOptions {
    std::string study;
    std::optional<std::uint64_t> trials;
    std::uint64_t seed = 1;
    unsigned threads = 0;
    std::string plot;
    std::vector<std::string> logs;
    bool json = false;
};

/// The recordings that the user names, or the two of one array that the data folder holds.
std::vector<std::filesystem::path> logs_of(const Study& study, const LabOptions& options)
{
    if (!study.recorded) return {};
    if (options.logs.size() == 1) fail("--log: two or more recordings of the same sensors are needed: each is calibrated by another one");
    if (!options.logs.empty()) return {options.logs.begin(), options.logs.end()};
    const char* const given = std::getenv("QUORIENT_DATA_DIR");
    const std::filesystem::path folder =
        (given != nullptr ? std::filesystem::path(given) : "../shared/data") / std::filesystem::path("mimu4444_carlsson");
    return {folder / "exp_1/data.bin", folder / "exp_2/data.bin"};
}

const Study& study_of(const LabOptions& options)
{
    for (const Study& study : studies)
        if (options.study == study.name) return study;
    fail(fmt::format(
        "unknown study '{}'; known are isolation, paper-002, ceiling, vessel, detection-delay, detection-seeds, motion-noise, motion-terms",
        options.study));
}

void run(const LabOptions& options)
{
    const Study& study = study_of(options);
    const lab::RunSettings settings{options.trials.value_or(study.trials), options.seed, options.threads, logs_of(study, options)};
    const lab::Report report = [&] {
        lab::Progress progress;
        return study.run(settings, [&progress](std::size_t done, std::size_t all) { progress.show(done, all); });
    }();
    if (!options.plot.empty()) write_svg(options.plot, report.charts);
    if (!options.json) {
        fmt::print("{}\n{} trials per scene, seed {}\n", report.text, settings.trials, settings.seed);
        return;
    }
    Json json{{"study", study.name}, {"trials", settings.trials}, {"seed", settings.seed}};
    json.update(report.json);
    fmt::print("{}\n", dump(json));
}

}  // namespace

void add_lab(CLI::App& program)
{
    auto* verb = program.add_subcommand("lab", "Monte Carlo: what the methods can tell, beside the published figures.");
    verb->footer(
        "isolation   methods x layouts x 0, 1, 2 faults, and the subset method over its margin\n"
        "paper-002   the figures of the paper that a fitted fault model reproduces\n"
        "ceiling     what a single sample can detect and isolate, per layout\n"
        "vessel      observers on the vessel of paper 001: false alarms and isolation with a model that is 5 % wrong\n"
        "detection-delay  faults added to two recordings of one array (--log twice), each corrected by the other's calibration\n"
        "detection-seeds  the same steps in violent motion with five seeds: how much the medians scatter\n"
        "motion-noise     the same steps in violent motion, with the detector's motion noise wrong by factors of 0.5 to 2\n"
        "motion-terms     the terms of that noise from each recording alone, and the other one played with them\n\n"
        "The result depends on trials and seed, not on the number of threads.\n\n"
        "Example: every method on the dodecahedron and the cone, with a plot\n"
        "  quorient lab isolation --trials 100000 --seed 1 --plot isolation.svg\n");
    const auto options = std::make_shared<LabOptions>();
    verb->add_option("study", options->study,
                     "isolation, paper-002, ceiling, vessel, detection-delay, detection-seeds, motion-noise or motion-terms")
        ->option_text("STUDY")
        ->required();
    verb->add_option("--trials", options->trials, "of each scene (default: what takes some seconds)")
        ->check(CLI::Range(std::uint64_t{1}, std::uint64_t{1'000'000'000}));
    verb->add_option("--seed", options->seed, "of the random numbers")->capture_default_str();
    verb->add_option("--threads", options->threads, "0 = one per core")->check(CLI::Range(0U, 1024U))->capture_default_str();
    verb->add_option("--plot", options->plot, "writes the charts to this SVG file");
    verb->add_option("--log", options->logs,
                     "studies of recordings: one of them; repeat it (default: the two in QUORIENT_DATA_DIR or ../shared/data)");
    verb->add_flag("--json", options->json, "one line of JSON, 17 significant digits");
    verb->callback([options] { run(*options); });
}

}  // namespace quorient::cli
