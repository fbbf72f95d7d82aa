#include "field_runs.hpp"

#include "cli/parallel.hpp"

#include "quorient/messages/name.hpp"

#include <random>
#include <stdexcept>

namespace quorient::studies {
namespace {

fdi::FaultMonitor monitor_on(const FieldLog& log, fdi::Mount mount, const fdi::FieldRules& rules)
{
    fdi::DetectorSettings settings{.method = "field"};
    settings.mount = mount;
    auto detector = fdi::FieldDetector::make(settings, log.cluster, rules);
    if (!detector) throw std::runtime_error(log.name + ": " + detector.error());
    auto monitor = fdi::FaultMonitor::make(std::move(*detector), {}, log.cluster);
    if (!monitor) throw std::runtime_error(log.name + ": " + monitor.error());
    return std::move(*monitor);
}

/// What a report needs to name axes.
ClusterDescription description_of(const geometry::SensorCluster& cluster)
{
    ClusterDescription description;
    description.axis_count = static_cast<std::uint8_t>(cluster.size());
    description.instrument_count = static_cast<std::uint8_t>(cluster.instrument_name.size());
    for (std::size_t axis = 0; axis < cluster.size(); ++axis) description.instrument[axis] = static_cast<std::uint8_t>(cluster.instrument[axis]);
    for (std::size_t m = 0; m < cluster.instrument_name.size(); ++m) copy_text(cluster.instrument_name[m], description.instrument_name[m]);
    return description;
}

}  // namespace

std::vector<FieldLog> load_field_logs(const std::vector<std::filesystem::path>& files)
{
    std::vector<FieldLog> logs;
    for (const auto& file : files) {
        const auto log = load_field_log(file);
        if (!log) throw std::runtime_error(log.error());
        for (const auto& set : instrument_sets(log->instruments())) logs.push_back(part_of(*log, set));
    }
    return logs;
}

std::vector<LogFigures> play_logs(const std::vector<FieldLog>& logs, const RunSettings& settings, const fdi::FieldRules& rules)
{
    std::vector<LogFigures> figures(logs.size());
    cli::for_each(logs.size(), settings.threads, {}, [&](std::size_t i) {
        const FieldLog& log = logs[i];
        figures[i] = {log.name, log.instruments(), log.duration_s(), description_of(log.cluster),
                      play_sound(log, monitor_on(log, settings.mount, rules))};
    });
    return figures;
}

std::vector<FaultFigures> inject_faults(const std::vector<FieldLog>& logs, const RunSettings& settings, const OnProgress& on_progress,
                                        const fdi::FieldRules& rules)
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
        figures[fault].runs[trial] = play_fault(log, injection, random(), monitor_on(log, settings.mount, rules));
    });
    return figures;
}

}  // namespace quorient::studies
