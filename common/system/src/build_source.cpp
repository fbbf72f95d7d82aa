#include "build.hpp"
#include "build_imus.hpp"

#include <fmt/format.h>
#include <algorithm>
#include <filesystem>

namespace quorient::system {

std::string beside(const System& system, const std::string& name)
{
    std::error_code failed;
    const auto path = std::filesystem::path(system.file).parent_path() / name;
    const auto absolute = std::filesystem::absolute(path, failed);
    return failed ? path.string() : absolute.lexically_normal().string();
}

namespace {

/// Where the file itself states the axes, it states their noise too; the field detector measures biases and noise itself, also in motion.
bool needs_rest(const File& file, const System& system)
{
    const bool all_measure = std::ranges::all_of(file.lanes, [](const LaneSection& lane) { return lane.detector.method.method == "field"; });
    return !system.sensor.cluster && !all_measure;
}

void build_log(const File& file, SourceSection& source, System& system, Report& report)
{
    LogSettings log;
    if (!source.imus.empty()) {  // a file for ROS 2 that replays its own recording, whose biases are taken out already
        take_mountings(source, system, report);
        source.rest_s = 0;
    }
    if (!source.rest_s) source.rest_s = needs_rest(file, system) ? LogSettings{}.rest_s : 0;
    log.rest_s = *source.rest_s;
    log.from_s = source.from_s;
    log.to_s = source.to_s;
    log.of_imus = !source.imus.empty();
    for (auto& name : source.files) {
        name = beside(system, name);
        log.files.push_back(name);
    }
    if (!source.calibration.empty() && source.imus.empty() && system.sensor.cluster)
        report.at("source.calibration", "states the axes, as unit.layout or unit.axes do: keep one of them");
    take_calibration(source, system, report);
    if (!system.sensor.cluster)
        for (const auto& [key, value] :
             {std::pair{"source.noise_rad", source.scenario.noise_rad}, std::pair{"source.quantum_rad", source.scenario.quantum}})
            if (value > 0)
                report.at(
                    key,
                    "has no axes to hold for: noise is that of the log at rest, or of the calibration; or state unit.layout or unit.axes");
    system.sensor.source.log = std::move(log);
}

void build_simulation(SourceSection& source, System& system, Report& report)
{
    auto& scenario = system.sensor.source.scenario;
    const auto motion = motion_of(source.motion);
    if (motion) scenario.motion = *motion;
    else report.at("source.motion", motion.error());
    if (system.sensor.levelled_heading_rad)
        report.at("source.kind", "a simulation has no accelerometers to level by: state unit.initial_attitude.specific_force_m_s2");
    if (!system.sensor.cluster) {
        if (!report.stands("unit.layout") && !report.stands("unit.axes"))
            report.at("source.kind", "a simulation needs unit.layout or unit.axes");
        return;
    }
    auto trial = scenario;
    trial.faults.clear();
    if (const auto ok = simulation::check(trial, *system.sensor.cluster); !ok) return report.at("source.quantize", ok.error());
    for (std::size_t i = 0; i < scenario.faults.size(); ++i) {
        trial.faults = {scenario.faults[i]};
        if (const auto ok = simulation::check(trial, *system.sensor.cluster); !ok)
            report.at(fmt::format("source.faults[{}]", i), ok.error());
    }
    if (scenario.faults.size() > simulation::FaultInjector::capacity)
        report.at("source.faults", simulation::check(scenario, *system.sensor.cluster).error());
}

void check_faults(const SourceSection& source, const geometry::SensorCluster& cluster, Report& report)
{
    for (std::size_t i = 0; i < source.faults.size(); ++i)
        if (const auto resolved = simulation::resolve(source.faults[i], cluster); !resolved)
            report.at(fmt::format("source.faults[{}]", i), resolved.error());
    if (source.faults.size() > simulation::FaultInjector::capacity)
        report.at("source.faults", fmt::format("at most {} faults fit", simulation::FaultInjector::capacity));
}

void build_vessel_source(SourceSection& source, System& system, Report& report)
{
    if (source.kind != SourceSection::Kind::simulation)
        report.at("source.kind", "a vessel's rates come from a simulation: no log format holds a rudder");
    auto& scenario = system.sensor.source.vessel.emplace(source.vessel);
    scenario.channels = system.channels;
    scenario.interval_s = system.interval_s;
    if (system.vessel) scenario.model = *system.vessel;
    if (source.plant.any()) {
        const auto model = model_of(source.plant);
        if (model) scenario.model = *model;
        else if (!model.error().what.empty()) report.at("source." + model.error().key, model.error().what);
    }
    scenario.faults = source.faults;
    if (scenario.model.a.size() == 0) return;  // reported already
    auto trial = scenario;
    trial.faults.clear();
    const auto possible = simulation::check(trial);
    if (!possible) return report.at(source.plant.plant ? "source.plant" : "source.duration_s", possible.error());
    for (std::size_t i = 0; i < scenario.faults.size(); ++i) {
        const auto resolved = simulation::resolve(scenario.faults[i], simulation::channels_of(scenario));
        if (resolved) scenario.faults[i] = *resolved;
        else report.at(fmt::format("source.faults[{}]", i), resolved.error());
    }
    system.sensor.source.scenario.faults = scenario.faults;
}

}  // namespace

void build_source(File& file, System& system, Report& report)
{
    auto& source = file.source;
    system.interval_s = interval_s_of(file);
    const auto stated_rate_hz = source.rate_hz;
    source.rate_hz = rate_hz_of(file);
    system.sensor.source.speed = source.speed;
    if (unit_kind(file.unit.kind).has_model) return build_vessel_source(source, system, report);

    if (!source.quantize) source.quantize = source.scenario.quantum > 0 ? simulation::Quantize::carry : simulation::Quantize::none;
    auto& scenario = system.sensor.source.scenario = source.scenario;
    scenario.interval_s = system.interval_s;
    scenario.faults = source.faults;
    switch (source.kind) {
        case SourceSection::Kind::log:
            build_log(file, source, system, report);
            system.sensor.source.log->stated_rate_hz = stated_rate_hz;
            break;
        case SourceSection::Kind::ros2_imu:
            build_imus(source, system, report);
            take_calibration(source, system, report);
            break;
        case SourceSection::Kind::simulation:
            scenario.quantize = *source.quantize;
            build_simulation(source, system, report);
            break;
    }
    if (auto& cluster = system.sensor.cluster) {
        if (!system.sensor.source.calibration) {
            cluster->sigma.setConstant(scenario.noise_rad);
            cluster->quantum.setConstant(scenario.quantum);
        }
        cluster->interval_s = scenario.interval_s;
        cluster->kind = system.sensor.kind;
        if (source.kind == SourceSection::Kind::ros2_imu) check_faults(source, *cluster, report);
    }
}

}  // namespace quorient::system
