#include "parse_bus.hpp"
#include "parse_detector.hpp"
#include "parse_ros2.hpp"
#include "parse_source.hpp"
#include "quorient/system/system.hpp"

#include <fmt/format.h>
#include <algorithm>
#include <set>

namespace quorient::system {

using runtime::Section;

namespace {

// Service ids are unique in a domain: 100 to a unit.
constexpr std::uint32_t services_per_unit = 100;
constexpr std::uint32_t sensor_service = 1;
constexpr std::uint32_t first_detector_service = 10;
constexpr std::uint32_t first_integrator_service = 20;
constexpr std::uint32_t first_voter_service = 30;
constexpr std::uint32_t monitor_service = 90;

ProcessSettings process_of(const System& system, const ProcessSettings& base, std::string name, std::uint32_t service, ServiceRole role)
{
    ProcessSettings process = base;
    process.node.name = std::move(name);
    process.node.unit = system.unit;
    process.node.service = system.unit * services_per_unit + service;
    process.node.role = role;
    process.bus.participant = process.node.name;
    return process;
}

/// The networks of a process on another host are not this host's to judge.
bool runs_here(const Overrides& overrides, const ProcessSettings& process)
{
    return overrides.process.empty() || overrides.process == process.node.name;
}

void parse_integration(Section section, IntegratorProcess& integrator)
{
    section.text("algorithm", integrator.integration.algorithm);
    section.number("history_s", integrator.integration.history_s, {.lowest = 0, .highest = 600, .lowest_included = false, .unit = "s"});
    section.boolean("rollback", integrator.integration.rollback);
    section.boolean("leave_out_suspects", integrator.integration.leave_out_suspects);
    section.number("lost_after_s", integrator.integration.lost_after_s, runtime::above_zero);
    section.number("patience", integrator.patience, {.lowest = 0, .highest = 1});
    section.finish();
}

void parse_integrator(Section& lane, const System& system, const ProcessSettings& own, LaneProcess& result, std::uint32_t place)
{
    auto& integrator = result.integrator;
    integrator.process = process_of(system, own, "attitude-" + result.name, first_integrator_service + place, ServiceRole::integrator);
    integrator.detector = result.detector.detector;
    integrator.kind = system.sensor.kind;
    integrator.integration.unit = system.unit;
    integrator.integration.lane = place + 1;
    parse_integration(lane.section("integrator"), integrator);
}

void parse_lane(Section lane, const System& system, const ProcessSettings& base, const Overrides& overrides, LaneProcess& result,
                std::uint32_t place)
{
    lane.require("name");
    result.name = fmt::format("lane-{}", place);
    lane.text("name", result.name);
    ProcessSettings own = base;
    parse_process(lane, overrides, own);

    auto& detector = result.detector;
    detector.process = process_of(system, own, "fdi-" + result.name, first_detector_service + place, ServiceRole::detector);
    detector.lane = detector.detector = place + 1;
    detector.kind = system.sensor.kind;
    parse_detector(lane, system, detector);
    if (system.has_attitude()) parse_integrator(lane, system, own, result, place);
    else if (lane.has("integrator")) lane.problem("integrator", "a vessel's rates give no attitude: there is nothing to integrate");
    if (runs_here(overrides, detector.process) || (system.has_attitude() && runs_here(overrides, result.integrator.process)))
        check_bus(lane, own);
    lane.finish();
}

void parse_lanes(Section& root, System& system, const ProcessSettings& base, const Overrides& overrides)
{
    root.require("lanes");
    auto sections = root.sections("lanes");
    if (sections.size() > max_lanes) root.problem("lanes", fmt::format("at most {} lanes, got {}", max_lanes, sections.size()));
    std::set<std::string> names;
    for (std::uint32_t place = 0; place < std::min(sections.size(), max_lanes); ++place) {
        auto& lane = system.lanes.emplace_back();
        parse_lane(sections[place], system, base, overrides, lane, place);
        if (!names.insert(lane.name).second) sections[place].problem("name", fmt::format("two lanes are called '{}'", lane.name));
    }
}

void parse_voting(Section section, voting::VoterSettings& voting)
{
    section.number("patience", voting.patience, {.lowest = 0, .highest = 10});
    section.number("agreement_rad", voting.agreement_rad, runtime::above_zero);
    section.number("agreement_sigmas", voting.agreement_sigmas, runtime::not_negative);
    section.whole("settle_frames", voting.settle_frames);
    section.number("silence_intervals", voting.silence_intervals, {.lowest = 1});
    section.number("coasting_to_lost_s", voting.coasting_to_lost_s, runtime::above_zero);
    section.whole("return_frames", voting.return_frames, 1);
    section.number("lease_s", voting.lease_s, {.lowest = 0.01, .unit = "s"});
    section.whole("level_window", voting.level_window, 1, 1000);
    section.whole("good_frames_before_owning", voting.good_frames_before_owning, 0, 10'000);
    section.finish();
}

void parse_voters(Section& root, System& system, const ProcessSettings& base, const Overrides& overrides)
{
    if (!system.has_attitude()) {
        for (const char* key : {"voters", "voting"})
            if (root.has(key)) root.problem(key, "a vessel's rates give no attitude: there is nothing to vote on");
        return;
    }
    voting::VoterSettings voting;
    voting.unit = system.unit;
    voting.interval_s = system.interval_s;
    voting.lease_s = std::max(0.05, 3 * system.interval_s);
    parse_voting(root.section("voting"), voting);
    for (const auto& lane : system.lanes) voting.lanes.push_back({lane.integrator.integration.lane, lane.detector.detector, lane.name});

    root.require("voters");
    auto sections = root.sections("voters");
    for (std::uint32_t place = 0; place < sections.size(); ++place) voting.voters.push_back(place + 1);
    for (std::uint32_t place = 0; place < sections.size(); ++place) {
        auto& section = sections[place];
        auto& voter = system.voters.emplace_back();
        std::string name = fmt::format("voter-{}", place + 1);
        section.text("name", name);
        ProcessSettings own = base;
        parse_process(section, overrides, own);
        voter.process = process_of(system, own, name, first_voter_service + place, ServiceRole::voter);
        voter.voting = voting;
        voter.voting.voter = place + 1;
        if (const auto ok = voting::check(voter.voting); !ok && !system.lanes.empty()) section.problem("name", ok.error());
        if (runs_here(overrides, voter.process)) check_bus(section, own);
        section.finish();
    }
}

void parse_expectations(Section section, Expectations& expect)
{
    if (section.has("isolated")) {
        std::vector<double> axes;
        section.numbers("isolated", axes, {.lowest = 0, .highest = max_axes - 1});
        expect.isolated = 0;
        for (const double axis : axes) *expect.isolated |= axis_bit(static_cast<std::size_t>(axis));
    }
    if (section.has("instrument")) {
        expect.instrument.emplace();
        section.text("instrument", *expect.instrument);
    }
    section.whole("within_frames", expect.within_frames);
    section.number("final_error_rad", expect.final_error_rad, runtime::above_zero);
    section.boolean("no_gap", expect.no_gap);
    section.number("each_fault_within_s", expect.each_fault_within_s, runtime::above_zero);
    section.finish();
}

void parse_sensor(Section section, System& system, const ProcessSettings& base, const Overrides& overrides)
{
    ProcessSettings own = base;
    parse_process(section, overrides, own);
    system.sensor.process = process_of(system, own, "sensor", sensor_service, ServiceRole::sensor);
    section.number("wait_s", system.sensor.wait_s, {.lowest = 0, .unit = "s"});
    if (runs_here(overrides, system.sensor.process)) check_bus(section, own);
    section.finish();
}

void list_consumers(System& system)
{
    auto& consumers = system.sensor.consumers;
    for (const auto& lane : system.lanes) {
        consumers.push_back(lane.detector.process.node.name);
        if (system.has_attitude()) consumers.push_back(lane.integrator.process.node.name);
    }
    for (const auto& voter : system.voters) consumers.push_back(voter.process.node.name);
}

}  // namespace

tl::expected<System, std::string> load(const std::string& file, const Overrides& overrides)
{
    auto document = runtime::load_yaml(file);
    if (!document) return tl::make_unexpected(document.error());
    runtime::Problems problems{file};
    for (const auto& assignment : overrides.set) {
        if (const auto done = runtime::assign(*document, assignment); !done) problems.add(done.error());
    }
    Section root{*document, "", problems};

    System system;
    system.file = file;
    system.name = file;
    root.text("name", system.name);
    ProcessSettings base;
    base.bus.interface = "lo";
    root.whole("domain", base.bus.domain, 0, 230);
    parse_process(root, overrides, base);
    parse_unit(root.section("unit"), system);
    parse_source(root.section("source"), system);
    base.bus.heartbeat_s = system.interval_s / 2;
    parse_sensor(root.section("sensor"), system, base, overrides);
    parse_lanes(root, system, base, overrides);
    parse_voters(root, system, base, overrides);
    parse_ros2_output(root, system);
    parse_expectations(root.section("expect"), system.expectations);
    if (!system.has_attitude() && (system.expectations.no_gap || system.expectations.final_error_rad))
        root.problem("expect", "a vessel's rates give no attitude: no_gap and final_error_rad cannot be met");
    list_consumers(system);
    system.monitor = process_of(system, base, "monitor", monitor_service, ServiceRole::monitor);
    system.monitor.bus.transport = Transport::udp;
    if (!system.voters.empty()) system.monitor.bus.voted_lease_s = system.voters.front().voting.lease_s;
    root.finish();

    if (!problems.empty()) return tl::make_unexpected(problems.text());
    return system;
}

}  // namespace quorient::system
