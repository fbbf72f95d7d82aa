// The field detector on any set of logs: as they are, with real faults, and with faults added to the sound ones.

#include "field_report.hpp"
#include "cli/parallel.hpp"
#include "study.hpp"

#include "quorient/fdi/methods.hpp"
#include "quorient/messages/name.hpp"

#include <random>
#include <stdexcept>

namespace quorient::studies {
namespace {

fdi::FaultMonitor monitor_on(const FieldLog& log, fdi::Mount mount)
{
    fdi::DetectorSettings settings{.method = "field"};
    settings.mount = mount;
    auto monitor = fdi::FaultMonitor::make(settings, {}, log.cluster);
    if (!monitor) throw std::runtime_error(log.name + ": " + monitor.error());
    return std::move(*monitor);
}

/// What the report needs to name axes.
ClusterDescription description_of(const geometry::SensorCluster& cluster)
{
    ClusterDescription description;
    description.axis_count = static_cast<std::uint8_t>(cluster.size());
    description.instrument_count = static_cast<std::uint8_t>(cluster.instrument_name.size());
    for (std::size_t axis = 0; axis < cluster.size(); ++axis) description.instrument[axis] = static_cast<std::uint8_t>(cluster.instrument[axis]);
    for (std::size_t m = 0; m < cluster.instrument_name.size(); ++m) copy_text(cluster.instrument_name[m], description.instrument_name[m]);
    return description;
}

/// Every log with each of its sets of instruments.
std::vector<FieldLog> load(const std::vector<std::filesystem::path>& files)
{
    std::vector<FieldLog> logs;
    for (const auto& file : files) {
        const auto log = load_field_log(file);
        if (!log) throw std::runtime_error(log.error());
        for (const auto& set : instrument_sets(log->instruments())) logs.push_back(part_of(*log, set));
    }
    return logs;
}

std::vector<SoundRun> play_all(const std::vector<FieldLog>& logs, const RunSettings& settings, const OnProgress& on_progress)
{
    std::vector<SoundRun> runs(logs.size());
    cli::for_each(logs.size(), settings.threads, on_progress, [&](std::size_t i) { runs[i] = play_sound(logs[i], monitor_on(logs[i], settings.mount)); });
    return runs;
}

/// Every fault in every log of three instruments or more, `trials` times.
std::vector<FaultFigures> inject_all(const std::vector<FieldLog>& logs, const RunSettings& settings, const OnProgress& on_progress)
{
    std::vector<const FieldLog*> able;
    for (const FieldLog& log : logs)
        if (log.instruments() >= 3) able.push_back(&log);
    std::vector<double> noise;
    for (const FieldLog* log : able) noise.push_back(sample_noise(*log));

    const auto faults = field_faults();
    const std::size_t trials = able.size() * settings.trials;
    std::vector<FaultFigures> figures;
    for (const FieldFault& fault : faults) figures.push_back({.fault = fault, .runs = std::vector<FaultRun>(trials)});
    cli::for_each(trials * faults.size(), settings.threads, on_progress, [&](std::size_t task) {
        const std::size_t fault = task / trials;
        const std::size_t trial = task % trials;
        const FieldLog& log = *able[trial / settings.trials];
        std::seed_seq seed{settings.seed, static_cast<std::uint64_t>(task)};
        std::mt19937_64 random(seed);
        const Injection injection = draw(log, faults[fault], noise[trial / settings.trials], random);
        figures[fault].runs[trial] = play_fault(log, injection, random(), monitor_on(log, settings.mount));
    });
    return figures;
}

}  // namespace

Report field(const RunSettings& settings, const OnProgress& on_progress)
{
    const std::vector<FieldLog> sound = load(settings.logs);
    const std::vector<FieldLog> faulty = load(settings.faulty_logs);
    FieldFigures figures;
    figures.mount = settings.mount;
    const auto rows = [](const std::vector<FieldLog>& logs, std::vector<SoundRun> runs) {
        std::vector<LogFigures> found;
        for (std::size_t i = 0; i < logs.size(); ++i)
            found.push_back({logs[i].name, logs[i].instruments(), logs[i].duration_s(), description_of(logs[i].cluster), runs[i]});
        return found;
    };
    figures.sound = rows(sound, play_all(sound, settings, {}));
    figures.faulty = rows(faulty, play_all(faulty, settings, {}));
    if (settings.trials > 0) figures.faults = inject_all(sound, settings, on_progress);
    return field_report(figures);
}

}  // namespace quorient::studies
