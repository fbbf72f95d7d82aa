#include "ros2.hpp"

#include "rotation.hpp"

#include <fmt/format.h>
#include <array>
#include <string>
#include <string_view>

namespace quorient::system {

using namespace configuration;

namespace {

constexpr std::string_view dds_prefix = "rt/";  // ROS 2's "/imu/data" is "rt/imu/data" to DDS

void read_topic(Section& section, const std::string& key, std::string& topic)
{
    std::string name;
    section.text(key, name);
    if (name.empty()) return;
    const bool ends_well = name.back() != '/';
    name.erase(0, name.find_first_not_of('/'));
    if (!ends_well || name.empty()) return section.problem(key, "expected a ROS 2 topic name, e.g. /imu/data");
    topic = name.starts_with(dds_prefix) ? name : std::string{dds_prefix} + name;
}

template <class Owner>
Rows<Owner> topic_row(Key key, std::string Owner::*member)
{
    key.form = "ROS 2 topic";
    const auto write = [member](const Owner& values) {
        const auto& topic = values.*member;
        return topic.empty() ? YAML::Node{YAML::NodeType::Undefined} : to_node(topic.substr(dds_prefix.size() - 1));
    };
    return own<Owner>(
        key, [name = key.name, member](Section& section, Owner& values) { read_topic(section, name, values.*member); }, write);
}

Rows<ImuSection> rotation_row()
{
    const auto read = [](Section& section, ImuSection& imu) {
        if (const auto rotation = read_rotation(section, "rotation")) imu.rotation = *rotation;
    };
    return own<ImuSection>(
        {.name = "rotation", .form = std::string{rotation_form}, .sentence = "Rotation from the IMU's frame to the body frame."}, read,
        [](const ImuSection& imu) { return rotation_node(imu.rotation); });
}

const Table<ImuSection>& imu_table()
{
    static const Table<ImuSection> table{
        "One IMU.",
        {required(topic_row({.name = "topic", .sentence = "Topic of its sensor_msgs/Imu."}, &ImuSection::topic)),
         value({.name = "name", .otherwise = "IMU1, IMU2, …", .sentence = "Its name in events and tables, up to 15 characters."},
               &ImuSection::name),
         rotation_row(),
         value({.name = "position_m", .unit = "m", .sentence = "Place of the IMU in the body frame."}, &ImuSection::position_m)}};
    return table;
}

}  // namespace

Rows<SourceSection> imus_row()
{
    return list<SourceSection, ImuSection>(
        {.name = "imus", .otherwise = "none", .sentence = "The IMUs, up to 8. Of a log: those that a system file for ROS 2 recorded."},
        &SourceSection::imus, imu_table(), max_axes / axes_per_imu,
        [](const SourceSection&, ImuSection& imu, std::size_t place) { imu.name = fmt::format("IMU{}", place + 1); });
}

Rows<SourceSection> ros2_source_rows()
{
    const auto figures = chosen(record<simulation::Scenario>(simulation::scenario_record()), {"noise_rad", "quantum_rad", "seed"});
    static const Table<SourceSection> table{
        "",
        {value({.name = "rate_hz",
                .unit = "Hz",
                .bounds = settings::Bounds{.lowest = 1, .highest = 20'000},
                .otherwise = "200",
                .sentence = "Frames a second; the IMUs have rates of their own."},
               &SourceSection::rate_hz),
         all_of(&SourceSection::scenario, figures),
         value({.name = "skew_s",
                .unit = "s",
                .bounds = settings::Bounds{.lowest = 0.001, .highest = 1},
                .sentence = "How far an IMU's stamps may be from those of the others, its longest gap, and how much later than the stamps "
                            "frames go out."},
               &SourceSection::skew_s),
         calibration_row(),
         value({.name = "rest_s",
                .unit = "s",
                .bounds = settings::not_negative,
                .otherwise = "2; 0 with a `calibration`, and for accelerometers",
                .sentence = "Rest at the start from which biases and, without `noise_rad`, the noise are learned. Where the IMUs move, frames "
                            "begin at once and the biases are not known."},
               &SourceSection::rest_s),
         required(imus_row())}};
    return table.rows();
}

const Table<Ros2OutputSettings>& ros2_output_table()
{
    static constexpr std::array<settings::Setting<Ros2OutputSettings>, 1> figures{
        {{"every", &Ros2OutputSettings::every, "frames", {.lowest = 1, .highest = 10'000}, "Send every n-th frame."}}};
    static const Table<Ros2OutputSettings> table{
        "The voted attitude for ROS 2, from every voter (conventions and QoS: idl/README.md).",
        {topic_row({.name = "imu", .sentence = "Topic of the sensor_msgs/Imu."}, &Ros2OutputSettings::imu),
         topic_row({.name = "diagnostics", .sentence = "Topic of the diagnostic_msgs/DiagnosticArray."}, &Ros2OutputSettings::diagnostics),
         value({.name = "frame_id", .sentence = "`frame_id` of the messages' headers."}, &Ros2OutputSettings::frame_id),
         record<Ros2OutputSettings>(figures),
         word<Ros2OutputSettings, bool>(
             {.name = "stamp", .sentence = "Time of the messages: `arrival` by the host's clock, `sample` by the instrument's own."},
             "stamp", &Ros2OutputSettings::sample_time, {{"arrival", false}, {"sample", true}})}};
    return table;
}

}  // namespace quorient::system
