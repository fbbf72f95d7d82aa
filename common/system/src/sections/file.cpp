#include "file.hpp"

#include "process.hpp"
#include "ros2.hpp"
#include "security.hpp"

#include <fmt/format.h>
#include <algorithm>
#include <array>

namespace quorient::system {

using namespace configuration;

namespace {

constexpr double default_rate_hz = 200;
constexpr double default_log_rate_hz = 62.5;
constexpr double default_vessel_rate_hz = 100;
constexpr double lease_intervals = 3;
constexpr std::size_t most_voters = 60;  // service ids: first_voter_service to monitor_service

constexpr std::array<settings::Setting<Expectations>, 4> expectations{{
    {"within_frames",
     &Expectations::within_frames,
     "frames",
     {},
     "Most frames from the fault's first one to the isolation by every lane.",
     "any time"},
    {"final_error_rad", &Expectations::final_error_rad, "rad", settings::above_zero,
     "Largest error of the voted attitude at the end, against the truth.", "any error"},
    {"no_gap", &Expectations::no_gap, "", {}, "No frame is missing in the voted stream, and none comes twice."},
    {"each_fault_within_s", &Expectations::each_fault_within_s, "s", settings::above_zero,
     "Every fault of the truth is isolated by every lane so soon and held until it ends, and nothing else is isolated.", "any time"},
}};

Rows<Expectations> isolated_row()
{
    const auto read = [](Section& section, Expectations& expect) {
        if (!section.has("isolated")) return;
        std::vector<std::uint32_t> axes;
        section.wholes("isolated", axes, {.lowest = 0, .highest = max_axes - 1});
        expect.isolated = 0;
        for (const auto axis : axes) *expect.isolated |= axis_bit(axis);
    };
    const auto write = [](const Expectations& expect) {
        if (!expect.isolated) return YAML::Node{YAML::NodeType::Undefined};
        std::vector<std::uint32_t> axes;
        for (std::uint32_t axis = 0; axis < max_axes; ++axis)
            if (has_axis(*expect.isolated, axis)) axes.push_back(axis);
        return to_node(axes);
    };
    return own<Expectations>({.name = "isolated",
                              .form = "list of whole numbers",
                              .bounds = settings::Bounds{.lowest = 0, .highest = max_axes - 1},
                              .otherwise = "any axes",
                              .sentence = "Exactly these axes, counted from 0, are isolated by every lane."},
                             read, write);
}

const Table<Expectations>& expectations_table()
{
    static const Table<Expectations> table{
        "What a run must show. `quorient launch` checks it against the simulation's truth, and its exit code says so.",
        {isolated_row(),
         value({.name = "instrument",
                .otherwise = "any",
                .sentence = "Every lane isolates axes of the instrument of this name, and no others."},
               &Expectations::instrument),
         record<Expectations>(expectations)}};
    return table;
}

void read_compositions(Section& section, File& file)
{
    if (!section.has("compose")) return;
    const auto node = section.raw("compose");
    if (!node.IsSequence()) return section.problem("compose", "expected a list of lists of names");
    for (std::size_t i = 0; i < node.size(); ++i) {
        std::vector<std::string> names;
        bool are_names = node[i].IsSequence();
        for (std::size_t j = 0; are_names && j < node[i].size(); ++j) {
            are_names = node[i][j].IsScalar();
            if (are_names) names.push_back(node[i][j].Scalar());
        }
        if (are_names) file.compositions.push_back(std::move(names));
        else section.problem("compose", i, "expected a list of names, e.g. [fdi-a, attitude-a]");
    }
}

YAML::Node compositions_node(const File& file)
{
    if (file.compositions.empty()) return YAML::Node{YAML::NodeType::Undefined};
    YAML::Node node{YAML::NodeType::Sequence};
    for (const auto& names : file.compositions) node.push_back(to_node(names));
    return node;
}

bool gives_attitude(const File& file)
{
    return unit_kind(file.unit.kind).gives_attitude;
}

void prepare_lane(const File& file, LaneSection& lane, std::size_t)
{
    lane.process = file.process;
    lane.unit_kind = file.unit.kind;
}

void prepare_voter(const File& file, VoterSection& voter, std::size_t place)
{
    voter.name = fmt::format("voter-{}", place + 1);
    voter.process = file.process;
}

Table<File> voter_tables()
{
    static const Table<voting::VoterSettings> voting{"How the voters choose (common/voting).",
                                                     {record<voting::VoterSettings>(voting::voter_record())}};
    return {"",
            {part<File, voting::VoterSettings>({.name = "voting", .sentence = "How the voters choose."}, &File::voting, voting,
                                               [](const File& file, voting::VoterSettings& settings) {
                                                   settings.lease_s = std::max(settings.lease_s, lease_intervals * interval_s_of(file));
                                               }),
             required(list<File, VoterSection>({.name = "voters", .sentence = "Strongest first."}, &File::voters, voter_table(),
                                               most_voters, prepare_voter)),
             part({.name = "ros2", .otherwise = "nothing is sent", .sentence = "The voted attitude for ROS 2."}, &File::ros2,
                  ros2_output_table())}};
}

Rows<File> no_voters()
{
    return refused<File>({"voters", "voting", "ros2"}, [](const File& file) {
        return fmt::format("{} give no attitude: there is nothing to vote on", unit_kind(file.unit.kind).subject);
    });
}

}  // namespace

double rate_hz_of(const File& file)
{
    const double otherwise = unit_kind(file.unit.kind).has_model            ? default_vessel_rate_hz
                             : file.source.kind == SourceSection::Kind::log ? default_log_rate_hz
                                                                            : default_rate_hz;
    return file.source.rate_hz.value_or(otherwise);
}

double interval_s_of(const File& file)
{
    return 1 / rate_hz_of(file);
}

const Table<File>& file_table()
{
    static const Table<File> table{
        "One file describes a unit, its source, all lanes and voters, and how their processes meet.",
        {value({.name = "name", .otherwise = "the file's name", .sentence = "Name of the system in tables and summaries."}, &File::name),
         all_of(&File::process, domain_row()), all_of(&File::process, process_rows()),
         part({.name = "unit", .sentence = "What is measured."}, &File::unit, unit_table()),
         part<File, SourceSection>({.name = "source", .sentence = "Where frames come from."}, &File::source, source_table(),
                                   [](const File& file, SourceSection& source) { source.unit_kind = file.unit.kind; }),
         part<File, runtime::OrderSettings>(
             {.name = "commands", .sentence = "Orders that the unit obeys."}, &File::commands, commands_table(),
             [](const File& file, runtime::OrderSettings& orders) { orders.inject = file.source.kind != SourceSection::Kind::ros2_imu; }),
         part<File, SensorSection>({.name = "sensor", .sentence = "The process that publishes frames."}, &File::sensor, sensor_table(),
                                   [](const File& file, SensorSection& sensor) { sensor.process = file.process; }),
         required(list<File, LaneSection>({.name = "lanes", .sentence = "Detector and integrator, side by side with others."}, &File::lanes,
                                          lane_table(), max_lanes, prepare_lane)),
         part<File, MonitorSection>({.name = "monitor", .otherwise = "there is none", .sentence = "A page of the running system."},
                                    &File::monitor, monitor_table(),
                                    [](const File& file, MonitorSection& monitor) { prepare_monitor(file.process, monitor); }),
         own<File>({.name = "compose",
                    .form = "list of lists of names",
                    .otherwise = "every process runs alone",
                    .sentence = "Processes that run in one, e.g. `[[fdi-a, attitude-a]]`: less latency and processor time, "
                                "but one that dies takes the others along. They need the same bus, and no `security`."},
                   read_compositions, compositions_node),
         part({.name = "expect", .sentence = "What a run must show."}, &File::expect, expectations_table())},
        {{"unit.kind: gyro", "The voted attitude.", gives_attitude, voter_tables().rows()},
         {"another unit.kind", "No voters.", [](const File& file) { return !gives_attitude(file); }, no_voters()}}};
    return table;
}

}  // namespace quorient::system
