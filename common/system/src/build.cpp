#include "build.hpp"
#include "quorient/security/token.hpp"
#include "quorient/system/numbers.hpp"

#include <fmt/format.h>

namespace quorient::system {

namespace {

ProcessSettings process_of(const System& system, const ProcessSettings& settings, std::string name, std::uint32_t service, ServiceRole role)
{
    ProcessSettings process = settings;
    process.node.name = std::move(name);
    process.node.unit = system.unit;
    process.node.service = system.unit * services_per_unit + service;
    process.node.role = role;
    process.bus.participant = process.node.name;
    process.bus.heartbeat_s = system.interval_s / 2;
    return process;
}

/// The motion noise that the calibration of the sensors states.
void take_calibration(const System& system, fdi::DetectorSettings& method)
{
    const auto& calibration = system.sensor.source.calibration;
    if (!calibration) return;
    method.calibrated = true;
    if (!method.motion_noise && calibration->motion_level > 0) method.motion_noise = calibration->motion_level;
    method.gated_noise = calibration->gated;
}

void build_detector(DetectorSection& file, const System& system, DetectorProcess& detector)
{
    detector.kind = system.sensor.kind;
    detector.verdict = file.verdict;
    if (!unit_kind(system.sensor.kind).has_model) {
        take_calibration(system, file.method);
        detector.detection = file.method;
        return;
    }
    const double noise = system.sensor.source.vessel ? system.sensor.source.vessel->noise : 0;
    if (file.observers.sigma.empty() && !file.observers.threshold && noise > 0) file.observers.sigma = {noise};
    auto& observers = detector.observers.emplace(file.observers);
    if (system.vessel) observers.plant = {system.vessel->a, system.vessel->b, system.vessel->c};
    detector.observer_margin = file.observer_margin;
}

void build_lane(LaneSection& file, System& system, std::uint32_t place)
{
    auto& lane = system.lanes.emplace_back();
    lane.name = file.name;
    lane.detector.process = process_of(system, file.process, "fdi-" + lane.name, first_detector_service + place, ServiceRole::detector);
    lane.detector.lane = lane.detector.detector = place + 1;
    build_detector(file.detector, system, lane.detector);
    if (!system.has_attitude()) return;
    auto& integrator = lane.integrator;
    integrator.process =
        process_of(system, file.process, "attitude-" + lane.name, first_integrator_service + place, ServiceRole::integrator);
    integrator.detector = lane.detector.detector;
    integrator.kind = system.sensor.kind;
    integrator.patience = file.integrator.patience;
    integrator.integration = file.integrator.integration;
    integrator.integration.unit = system.unit;
    integrator.integration.lane = place + 1;
}

void build_voters(const File& file, System& system)
{
    voting::VoterSettings voting = file.voting;
    voting.unit = system.unit;
    voting.interval_s = system.interval_s;
    for (const auto& lane : system.lanes) voting.lanes.push_back({lane.integrator.integration.lane, lane.detector.detector, lane.name});
    for (std::uint32_t place = 0; place < file.voters.size(); ++place) voting.voters.push_back(place + 1);
    for (std::uint32_t place = 0; place < file.voters.size(); ++place) {
        auto& voter = system.voters.emplace_back();
        voter.process =
            process_of(system, file.voters[place].process, file.voters[place].name, first_voter_service + place, ServiceRole::voter);
        voter.voting = voting;
        voter.voting.voter = place + 1;
        voter.ros2 = file.ros2;
    }
}

void build_monitor(File& file, System& system)
{
    if (!file.monitor) return;
    auto& monitor = system.web_monitor.emplace();
    monitor.process = process_of(system, file.monitor->process, file.monitor->name, web_monitor_service, ServiceRole::monitor);
    monitor.address = file.monitor->address;
    monitor.port = file.monitor->port;
    monitor.allow_orders = file.monitor->allow_orders;
    if (!file.monitor->token_file.empty()) file.monitor->token_file = beside(system, file.monitor->token_file);
    monitor.token_file = file.monitor->token_file;
    if (!system.voters.empty()) monitor.process.bus.voted_lease_s = system.voters.front().voting.lease_s;
}

/// What the file says once for all processes, and files that count from its folder.
void prepare_processes(File& file, const System& system)
{
    for_each_process(file, [&](const std::string&, ProcessSettings& process) {
        process.node.orders = file.commands;
        if (!process.security.directory.empty()) process.security.directory = beside(system, process.security.directory);
    });
}

void list_consumers(System& system)
{
    auto& consumers = system.sensor.consumers;
    for (const auto& lane : system.lanes) consumers.push_back(lane.detector.process.node.name);
    for (const auto* integrator : system.integrators()) consumers.push_back(integrator->process.node.name);
    for (const auto& voter : system.voters) consumers.push_back(voter.process.node.name);
}

/// What the bus finds wrong with a process of this host, at the process's own key or at the one of the whole file.
void check_bus(const ProcessSettings& process, const std::string& section, const Overrides& overrides, Report& report)
{
    if (overrides.any_host || !overrides.concerns(process.node.name)) return;
    for (const auto& finding : bus::findings(process.bus)) {
        const auto own = fmt::format("{}.{}", section, finding.key);
        const std::string whole{finding.key};
        report.at(!report.stands(own) && report.stands(whole) ? whole : own, finding.text);
    }
}

void check_buses(const System& system, const Overrides& overrides, Report& report)
{
    check_bus(system.sensor.process, "sensor", overrides, report);
    for (std::size_t i = 0; i < system.lanes.size(); ++i) {
        check_bus(system.lanes[i].detector.process, fmt::format("lanes[{}]", i), overrides, report);
        if (system.has_attitude()) check_bus(system.lanes[i].integrator.process, fmt::format("lanes[{}]", i), overrides, report);
    }
    for (std::size_t i = 0; i < system.voters.size(); ++i)
        check_bus(system.voters[i].process, fmt::format("voters[{}]", i), overrides, report);
    if (system.web_monitor) check_bus(system.web_monitor->process, "monitor", overrides, report);
}

/// The token of the monitor's orders is a secret of this host, as keys are.
void check_token(const File& file, const Overrides& overrides, Report& report)
{
    if (!file.monitor || file.monitor->token_file.empty()) return;
    if (!overrides.joins || overrides.any_host || !overrides.concerns(file.monitor->name)) return;
    if (const auto token = security::Token::read(file.monitor->token_file); !token) report.at("monitor.token_file", token.error());
}

void check_expectations(const System& system, Report& report)
{
    if (system.has_attitude()) return;
    for (const auto& [key, asked] : {std::pair{"expect.no_gap", system.expectations.no_gap},
                                     std::pair{"expect.final_error_rad", system.expectations.final_error_rad.has_value()}})
        if (asked) report.at(key, fmt::format("{} give no attitude: this cannot be met", unit_kind(system.sensor.kind).subject));
}

}  // namespace

System build(const std::string& name, File& file, const Overrides& overrides, Report& report)
{
    System system;
    system.file = name;
    if (file.name.empty()) file.name = system.file;
    system.name = file.name;
    prepare_processes(file, system);
    build_unit(file, system, report);
    build_source(file, system, report);
    system.sensor.process = process_of(system, file.sensor.process, "sensor", sensor_service, ServiceRole::sensor);
    system.sensor.wait_s = file.sensor.wait_s;
    for (std::uint32_t place = 0; place < file.lanes.size(); ++place) build_lane(file.lanes[place], system, place);
    build_voters(file, system);
    list_consumers(system);
    system.expectations = file.expect;
    system.monitor = process_of(system, file.process, "monitor", monitor_service, ServiceRole::monitor);
    system.monitor.bus.transport = Transport::udp;
    if (!system.voters.empty()) system.monitor.bus.voted_lease_s = system.voters.front().voting.lease_s;
    build_monitor(file, system);
    system.compositions = file.compositions;
    build_security(system, overrides, report);

    check_names(file, report);
    check_compositions(system, report);
    check_algorithms(system, report);
    check_buses(system, overrides, report);
    check_token(file, overrides, report);
    check_expectations(system, report);
    return system;
}

}  // namespace quorient::system
