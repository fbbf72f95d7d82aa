#include "source.hpp"

#include "ros2.hpp"

#include <fmt/format.h>
#include <cmath>
#include <utility>

namespace quorient::system {

using namespace configuration;

namespace {

using SourceKind = SourceSection::Kind;

void read_faults(Section& section, SourceSection& source)
{
    std::vector<std::string> texts;
    section.texts("faults", texts);
    for (std::size_t i = 0; i < texts.size(); ++i) {
        if (const auto fault = simulation::parse_fault(texts[i])) source.faults.push_back(*fault);
        else section.problem("faults", i, fault.error());
    }
}

Rows<SourceSection> faults_row()
{
    const auto write = [](const SourceSection& source) {
        std::vector<std::string> texts;
        for (const auto& fault : source.faults) texts.push_back(simulation::to_string(fault));
        auto node = to_node(texts);
        node.SetStyle(YAML::EmitterStyle::Block);
        return node;
    };
    return own<SourceSection>({.name = "faults",
                               .form = "list of texts",
                               .otherwise = "none",
                               .sentence = "Faults that are put in, e.g. `axis=1,kind=scale,value=0.8,start=8,end=18`; kinds and "
                                           "units: common/simulation."},
                              read_faults, write);
}

Rows<SourceSection> scenario_rows(std::initializer_list<std::string_view> keys)
{
    return all_of(&SourceSection::scenario, chosen(record<simulation::Scenario>(simulation::scenario_record()), keys));
}

Rows<SourceSection> rate_row(const std::string& otherwise)
{
    return value({.name = "rate_hz",
                  .unit = "Hz",
                  .bounds = settings::Bounds{.lowest = 1, .highest = 20'000},
                  .otherwise = otherwise,
                  .sentence = "Frames a second."},
                 &SourceSection::rate_hz);
}

Rows<SourceSection> speed_row()
{
    return value({.name = "speed", .bounds = settings::above_zero, .sentence = "Frames are published so many times faster than real time."},
                 &SourceSection::speed);
}

Rows<SourceSection> quantize_row()
{
    std::vector<std::pair<std::string, std::optional<simulation::Quantize>>> words;
    for (const auto& [text, way] : simulation::quantize_words()) words.emplace_back(text, way);
    return word<SourceSection, std::optional<simulation::Quantize>>(
        {.name = "quantize",
         .otherwise = "carry with a `quantum_rad`, else none",
         .sentence =
             "How an increment becomes a whole number of quanta: with the remainder carried, or truncated for each axis, or for each "
             "body axis."},
        "quantisation", &SourceSection::quantize, words);
}

Table<SourceSection> simulation_table()
{
    return {"",
            {rate_row("200"), speed_row(), scenario_rows({"duration_s", "seed", "noise_rad", "quantum_rad"}), quantize_row(),
             part({.name = "motion", .sentence = "How the body turns."}, &SourceSection::motion, motion_table())}};
}

void read_files(Section& section, SourceSection& source)
{
    if (section.has("file") && section.raw("file").IsSequence()) {
        section.texts("file", source.files);
        if (source.files.empty()) section.problem("file", "expected the name of a log, or a list of them");
        return;
    }
    std::string file;
    section.text("file", file);
    if (!file.empty()) source.files = {file};
}

Rows<SourceSection> file_row()
{
    const auto write = [](const SourceSection& source) {
        if (source.files.size() == 1) return to_node(source.files.front());
        return source.files.empty() ? YAML::Node{YAML::NodeType::Undefined} : to_node(source.files);
    };
    return required(own<SourceSection>(
        {.name = "file",
         .form = "text, or list of texts",
         .sentence = "The log, from the folder of the system file; several are instruments that logged one motion apart, merged by time."},
        read_files, write));
}

}  // namespace

Rows<SourceSection> calibration_row()
{
    const auto read = [](Section& section, SourceSection& source) { section.text("calibration", source.calibration); };
    const auto write = [](const SourceSection& source) {
        return source.calibration.empty() ? YAML::Node{YAML::NodeType::Undefined} : to_node(source.calibration);
    };
    return own<SourceSection>(
        {.name = "calibration",
         .form = "text",
         .otherwise = "none",
         .sentence =
             "Cluster file of `quorient calibrate`, from the folder of the system file: axes, gains and noise of these very sensors."},
        read, write);
}

namespace {

Table<SourceSection> log_table()
{
    constexpr auto of_simulation = "Passed over, so that a simulation's file serves to replay its own recording.";
    return {"",
            {file_row(), rate_row("62.5"), speed_row(),
             value({.name = "rest_s",
                    .unit = "s",
                    .bounds = settings::not_negative,
                    .otherwise = "10; 0 where `unit` states the axes or all methods are `field`",
                    .sentence = "Beginning of the log that is at rest: biases, and without a calibration sigmas, come from it."},
                   &SourceSection::rest_s),
             calibration_row(),
             value({.name = "from_s", .unit = "s", .bounds = settings::not_negative, .sentence = "Play from this time of the log on."},
                   &SourceSection::from_s),
             value({.name = "to_s",
                    .unit = "s",
                    .bounds = settings::above_zero,
                    .otherwise = "its end",
                    .sentence = "Play up to this time of the log."},
                   &SourceSection::to_s),
             scenario_rows({"seed", "noise_rad", "quantum_rad"}), passed_over<SourceSection>({.name = "motion", .sentence = of_simulation}),
             passed_over<SourceSection>({.name = "duration_s", .sentence = of_simulation}),
             passed_over<SourceSection>({.name = "quantize", .sentence = of_simulation}), imus_row(),
             passed_over<SourceSection>(
                 {.name = "skew_s", .sentence = "Passed over, so that a file for ROS 2 serves to replay its own recording."})}};
}

template <SensorKind unit_kind>
bool is_unit(const SourceSection& source)
{
    return source.unit_kind == unit_kind;
}

template <SourceKind kind>
bool is(const SourceSection& source)
{
    return source.kind == kind;
}

/// Times at which the rudder's angle gets lost; infinite: never.
Rows<simulation::VesselScenario> lost_row(const std::string& key, double simulation::VesselScenario::*member, const std::string& sentence)
{
    const auto read = [key, member](Section& section, simulation::VesselScenario& vessel) {
        section.number(key, vessel.*member, settings::not_negative, "s");
    };
    const auto write = [member](const simulation::VesselScenario& vessel) {
        return std::isfinite(vessel.*member) ? to_node(vessel.*member) : YAML::Node{YAML::NodeType::Undefined};
    };
    return own<simulation::VesselScenario>(
        {.name = key, .form = "number", .unit = "s", .bounds = settings::not_negative, .otherwise = "never", .sentence = sentence}, read,
        write);
}

Table<simulation::VesselScenario> rudder_table()
{
    using simulation::VesselScenario;
    return {"The sine that the rudder follows.",
            {record<VesselScenario>(simulation::rudder_record()),
             lost_row("lost_from_s", &VesselScenario::rudder_lost_from_s,
                      "Time from which on the rudder's angle is not reported, while it moves on."),
             lost_row("lost_to_s", &VesselScenario::rudder_lost_to_s, "Time at which it is reported again.")}};
}

Table<SourceSection> vessel_table()
{
    return {"",
            {rate_row("100"), speed_row(), all_of(&SourceSection::vessel, record<simulation::VesselScenario>(simulation::vessel_record())),
             part({.name = "rudder", .sentence = "What the rudder does."}, &SourceSection::vessel, rudder_table()),
             all_of(&SourceSection::plant, plant_rows())}};
}

}  // namespace

const Table<SourceSection>& source_table()
{
    static const Table<SourceSection> table{
        "Where the frames come from.",
        {word<SourceSection, SourceKind>({.name = "kind", .sentence = "A simulation, a recording, or IMUs of a robot."}, "source",
                                         &SourceSection::kind,
                                         {{"simulation", SourceKind::simulation}, {"log", SourceKind::log}, {"ros2_imu", SourceKind::ros2_imu}}),
         faults_row()},
        {{"unit.kind: vessel_rates",
          "A simulated vessel. `plant` or `vessel` state what really sails where it is not what the detectors believe.",
          is_unit<SensorKind::vessel_rates>, vessel_table().rows()},
         {"kind: simulation", "A simulated instrument on a moving body.", is<SourceKind::simulation>, simulation_table().rows()},
         {"kind: log", "A log that is played as if the sensors were here.", is<SourceKind::log>, log_table().rows()},
         {"kind: ros2_imu", "Several IMUs of a robot (sensor_msgs/Imu) as one cluster; their mountings are the axes.", is<SourceKind::ros2_imu>,
          ros2_source_rows()}}};
    return table;
}

}  // namespace quorient::system
