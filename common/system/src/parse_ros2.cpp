#include "parse_ros2.hpp"

#include <fmt/format.h>
#include <Eigen/Geometry>
#include <cmath>
#include <set>

namespace quorient::system {

using runtime::Section;

namespace {

/// ROS 2's "/imu/data" is "rt/imu/data" to DDS.
void parse_topic(Section& section, const char* key, std::string& topic)
{
    std::string name;
    section.text(key, name);
    if (name.empty()) return;
    const bool ends_well = name.back() != '/';
    name.erase(0, name.find_first_not_of('/'));
    if (!ends_well || name.empty()) return section.problem(key, "expected a ROS 2 topic name, e.g. /imu/data");
    topic = name.starts_with("rt/") ? name : "rt/" + name;
}

constexpr std::size_t axes_per_imu = 3;

/// `rotation: [w, x, y, z]`, IMU frame -> body frame.
void parse_mounting(Section& imu, Ros2ImuSettings& settings)
{
    std::vector<double> rotation{1, 0, 0, 0}, position_m{0, 0, 0};
    imu.numbers("rotation", rotation);
    imu.numbers("position_m", position_m);
    const bool quaternion = rotation.size() == 4 && std::abs(Eigen::Map<const Eigen::Vector4d>(rotation.data()).norm() - 1) < 1e-6;
    if (quaternion) settings.mounting = Eigen::Quaterniond(rotation[0], rotation[1], rotation[2], rotation[3]).normalized().matrix();
    else imu.problem("rotation", "expected a unit quaternion [w, x, y, z]: IMU frame -> body frame");
    if (position_m.size() == 3) settings.position_m = Eigen::Map<const Eigen::Vector3d>(position_m.data());
    else imu.problem("position_m", "expected [x, y, z] in the body frame [m]");
}

/// An IMU's axes in the body frame are the columns of its mounting.
void make_cluster(Section& source, System& system, const std::vector<Ros2ImuSettings>& imus)
{
    geometry::Axes axes(static_cast<Eigen::Index>(axes_per_imu * imus.size()), 3);
    std::vector<std::size_t> instrument;
    for (std::size_t i = 0; i < imus.size(); ++i) {
        axes.middleRows<axes_per_imu>(static_cast<Eigen::Index>(axes_per_imu * i)) = imus[i].mounting.transpose();
        instrument.insert(instrument.end(), axes_per_imu, i);
    }
    auto cluster = geometry::make_cluster(axes, instrument);
    if (!cluster) return source.problem("imus", cluster.error());
    for (std::size_t i = 0; i < imus.size(); ++i) cluster->instrument_name[i] = imus[i].name;
    system.sensor.cluster = std::move(*cluster);
}

}  // namespace

void parse_ros2_source(Section& source, System& system)
{
    if (system.sensor.cluster) source.problem("kind", "the IMUs' mountings are the axes: leave unit.layout and unit.axes out");
    Ros2SourceSettings settings;
    source.number("skew_s", settings.skew_s, {.lowest = 0.001, .highest = 1, .unit = "s"});
    source.require("imus");
    auto sections = source.sections("imus");
    if (sections.size() > max_axes / axes_per_imu)
        source.problem("imus", fmt::format("at most {} IMUs, got {}", max_axes / axes_per_imu, sections.size()));
    std::set<std::string> topics;
    for (auto& section : sections) {
        auto& imu = settings.imus.emplace_back();
        imu.name = fmt::format("IMU{}", settings.imus.size());
        section.text("name", imu.name);
        section.require("topic");
        parse_topic(section, "topic", imu.topic);
        if (!topics.insert(imu.topic).second) section.problem("topic", fmt::format("two IMUs are heard on '{}'", imu.topic));
        parse_mounting(section, imu);
        section.finish();
    }
    if (!settings.imus.empty() && settings.imus.size() <= max_axes / axes_per_imu) make_cluster(source, system, settings.imus);
    system.sensor.source.ros2 = std::move(settings);
}

void parse_ros2_output(Section& root, System& system)
{
    if (!root.has("ros2")) return;
    Section section = root.section("ros2");
    Ros2OutputSettings output;
    parse_topic(section, "imu", output.imu);
    parse_topic(section, "diagnostics", output.diagnostics);
    section.text("frame_id", output.frame_id);
    section.whole("every", output.every, 1, 10'000);
    std::string stamp = "arrival";
    section.text("stamp", stamp);
    output.sample_time = stamp == "sample";
    if (stamp != "sample" && stamp != "arrival")
        section.problem("stamp",
                        fmt::format("unknown stamp '{}'; known are arrival (the host's clock) and sample (the instrument's)", stamp));
    section.finish();
    for (auto& voter : system.voters) voter.ros2 = output;
}

}  // namespace quorient::system
