#include "report/calibration_report.hpp"
#include "cli/cluster_input.hpp"
#include "cli/program.hpp"
#include "quorient/calibration/gated_terms.hpp"
#include "cli/json_output.hpp"
#include "cli/log_choice.hpp"
#include "cli/output_file.hpp"
#include "cli/progress.hpp"
#include "cli/system_options.hpp"
#include "record/live_samples.hpp"
#include "quorient/calibration/log_sample.hpp"
#include "quorient/messages/name.hpp"
#include "quorient/recording/merge.hpp"
#include "report/sample_store.hpp"
#include "verbs.hpp"

#include <fmt/format.h>
#include <algorithm>
#include <filesystem>
#include <memory>
#include <optional>
#include <vector>

namespace quorient::cli {

namespace {

struct CalibrateOptions {
    std::vector<std::string> logs;
    SystemOptions live;  ///< whose file is named: a running unit in place of logs
    double duration_s = 60;
    LogChoice log;
    ClusterChoice choice;
    std::string out;
    std::string plot;
    calibration::RestSettings rest;
    bool force = false;
    bool json = false;
};

/// The samples of a whole log, in bounded memory.
SampleStore read_samples(recording::Reader& reader)
{
    SampleStore samples(reader.description().axis_count);
    recording::RecordedFrame frame;
    Progress progress;
    progress.title("frames read");
    for (auto outcome = reader.next(frame); outcome != recording::ReadOutcome::end; outcome = reader.next(frame)) {
        progress.show(samples.size());
        if (outcome == recording::ReadOutcome::rejected) fmt::print(stderr, "{}\n", reader.problem());
        else if (!samples.add(calibration::sample_of(frame))) fail(no_room_for_samples);
    }
    if (!samples.flush()) fail(no_room_for_samples);
    return samples;
}

/// The log's own nominal axes, or those that the user names: a plain CSV has none.
ClusterDescription nominal_cluster(const CalibrateOptions& options, const recording::Reader& reader)
{
    ClusterDescription nominal = reader.description();
    if (options.choice.name().empty()) {
        const bool known =
            std::any_of(nominal.axis.begin(), nominal.axis.end(), [](const auto& axis) { return axis != std::array<double, 3>{}; });
        if (!known) fail(fmt::format("{} does not say where its axes point: name --layout or --axes", options.logs.front()));
        return nominal;
    }
    const auto cluster = load_cluster(options.choice);
    if (!cluster) fail(cluster.error());
    if (cluster->size() != nominal.axis_count)
        fail(fmt::format("{} has {} axes, {} has {}", options.choice.name(), cluster->size(), options.logs.front(), nominal.axis_count));
    nominal.instrument_count = static_cast<std::uint8_t>(cluster->instrument_name.size());
    for (std::size_t axis = 0; axis < cluster->size(); ++axis) {
        Eigen::Vector3d::Map(nominal.axis[axis].data()) = cluster->axes.row(static_cast<Eigen::Index>(axis));
        nominal.instrument[axis] = static_cast<std::uint8_t>(cluster->instrument[axis]);
    }
    for (std::size_t i = 0; i < cluster->instrument_name.size(); ++i) copy_text(cluster->instrument_name[i], nominal.instrument_name[i]);
    return nominal;
}

struct Result {
    calibration::Calibration calibration;
    Searches searches;
};

/// All fits, each of which reads the samples more than once; the bar shows where in them it is.
Result fit(SampleStore& samples, const ClusterDescription& nominal, const std::string& name, const CalibrateOptions& options)
{
    Progress progress;
    samples.on_read([&](std::size_t index) { progress.show(index, samples.size()); });
    progress.title("rest and axes");
    auto calibration = calibration::calibrate(samples, nominal, options.rest);
    if (!calibration) fail(fmt::format("{}: {}", name, calibration.error()));
    progress.title("terms of the gated sums");
    calibration->cluster.gated = gated_terms(samples, nominal, *calibration, options.rest);
    progress.title("level of the motion noise");
    Searches found{.level = motion_level(samples, *calibration), .silence = {}};
    calibration->cluster.motion_level = found.level ? found.level->level : 0;
    progress.title("replay");
    found.silence = make_silent(samples, *calibration);
    samples.on_read({});
    return {std::move(*calibration), std::move(found)};
}

/// Fits, and says what they show.
void conclude(SampleStore& samples, const ClusterDescription& nominal, const std::string& name, const recording::Statistics& statistics,
              const CalibrateOptions& options, std::optional<OutputFile>& out, std::optional<OutputFile>& plot)
{
    auto [calibration, found] = fit(samples, nominal, name, options);
    calibration.cluster.origin = name;
    if (options.json) fmt::print("{}\n", dump(calibration_json(calibration, found, samples, statistics)));
    else fmt::print("{}", calibration_text(calibration, found, samples, statistics));
    if (out) {
        out->stream() << calibration::to_yaml(calibration.cluster);
        out->finish_document();
    }
    if (plot) write_svg(*plot, calibration_charts(calibration));
}

void run(const CalibrateOptions& options)
{
    const bool live = !options.live.file.empty();
    if (live == !options.logs.empty()) fail("name logs, or a running system by --live SYSTEM.yaml");
    std::vector<std::string> inputs = options.logs;
    inputs.push_back(options.live.file);
    refuse_shared_names(inputs, {options.out, options.plot});
    std::optional<OutputFile> out, plot;
    if (!options.out.empty()) out.emplace(options.out, options.force);
    if (!options.plot.empty()) plot.emplace(options.plot, options.force);
    if (live) {
        const auto system = options.live.load();
        auto received = receive_samples(system, options.duration_s);
        return conclude(received.samples, received.nominal, system.name, received.statistics, options, out, plot);
    }
    const std::vector<std::filesystem::path> files(options.logs.begin(), options.logs.end());
    const auto merged = recording::open_logs(files, options.log.options());
    if (!merged) fail(merged.error());
    for (std::size_t i = 1; i < files.size(); ++i)
        fmt::print(stderr, "{}: its clock shows {:+.4f} s against {} (correlation {:.3f})\n", options.logs[i], merged->offsets[i].offset_s,
                   options.logs.front(), merged->offsets[i].correlation);
    recording::Reader& reader = *merged->reader;
    for (const auto& remark : merged->remarks) fmt::print(stderr, "{}\n", remark);
    const ClusterDescription nominal = nominal_cluster(options, reader);
    auto samples = read_samples(reader);
    conclude(samples, nominal, files.front().filename().string(), reader.statistics(), options, out, plot);
}

}  // namespace

void add_calibrate(Program& program)
{
    auto verb = program.verb("calibrate", "Finds bias, noise, axes, motion noise and limits of the gyros in a recording.");
    verb.footer(
        "From resting segments: biases, noise, Allan deviation; from motion about all three axes, with more than three axes:\n"
        "directions and gains. Without rest, biases and noise are those in which the axes disagree. From violent motion of three\n"
        "instruments or more: the noise that their detector has to bear. --out writes the cluster file that a publisher reads.\n\n"
        "Example:\n"
        "  quorient calibrate exp_1/data.bin --out cluster.yaml --plot calibration.svg\n"
        "  quorient calibrate --live robot.yaml --duration 60 --out cluster.yaml\n");
    verb.not_as_asked_if("no frame of the running system came");
    const auto options = std::make_shared<CalibrateOptions>();
    verb.arguments("log", options->logs,
                     "any log of gyros: ArduPilot, PX4, ROS 2 bag, CSV, MIMU4444, Xsens DOT; several of one motion are merged")
        .value_name("LOG ...");
    verb.option("--live", options->live.file, "a running system in place of a log, by its system file").value_name("SYSTEM.yaml");
    verb.option("--duration", options->duration_s, "how long to receive its frames, s; Ctrl-C ends it sooner")
        .within(settings::above_zero)
        .shows_default();
    verb.option("--domain", options->live.domain, "its DDS domain in place of the file's").within(bus::bus_record(), "domain");
    verb.option("--set", options->live.set, "a value in place of the system file's (repeatable)").value_name("KEY=VALUE");
    options->log.add_to(verb);
    add_cluster_options(verb, options->choice);
    verb.option("--out", options->out, "cluster file to write (YAML)");
    verb.option("--plot", options->plot, "Allan deviation and motion noise, as SVG");
    verb.option("--rest-s", options->rest.shortest_s, "shortest rest that counts, s")
        .within(settings::above_zero)
        .shows_default();
    add_force(verb, options->force);
    verb.flag("--json", options->json, "one JSON object");
    verb.run([options] { run(*options); });
}

}  // namespace quorient::cli
