#include "build_imus.hpp"

#include "quorient/messages/name.hpp"
#include "sections/ros2.hpp"

#include <fmt/format.h>
#include <Eigen/Geometry>
#include <cmath>
#include <numbers>
#include <set>

namespace quorient::system {
namespace {

/// No assembly error is larger, no deliberate mounting smaller.
constexpr double largest_misalignment_rad = 10 * std::numbers::pi / 180;

/// The noise of a calibration is that of one increment: it holds for frames of about the same length.
constexpr double interval_tolerance = 0.05;

Eigen::Quaterniond mounting_of(const ImuSection& imu)
{
    return {imu.rotation[0], imu.rotation[1], imu.rotation[2], imu.rotation[3]};
}

/// A log of the IMUs themselves names them by their topics.
bool is_named(std::string_view name, const ImuSection& imu)
{
    const std::string topic = imu.topic.substr(std::min(imu.topic.size(), imu.topic.find('/')));
    Name<16> cut{};
    copy_text(topic, cut);
    return name == imu.name || name == topic || name == text_of(cut);
}

/// What shows that a calibration is not of these IMUs, or not in the body frame of this file; empty if nothing does.
std::string problem_of(const ClusterDescription& calibrated, const SourceSection& source)
{
    const std::size_t axes = axes_per_imu * source.imus.size();
    if (calibrated.kind != octet(SensorKind::gyro)) return "is not of gyros";
    if (calibrated.axis_count != axes) return fmt::format("has {} axes, the IMUs have {}", calibrated.axis_count, axes);
    for (std::size_t axis = 0; axis < axes; ++axis) {
        const ImuSection& imu = source.imus[axis / axes_per_imu];
        const auto name = text_of(calibrated.instrument_name[calibrated.instrument[axis]]);
        if (!is_named(name, imu)) return fmt::format("is of other sensors: axis {} is of instrument {}, here of {}", axis, name, imu.name);
        const Eigen::Vector3d mounted = mounting_of(imu) * Eigen::Vector3d::Unit(static_cast<Eigen::Index>(axis % axes_per_imu));
        const Eigen::Vector3d found(calibrated.axis[axis].data());
        const double angle = std::atan2(found.cross(mounted).norm(), found.dot(mounted));
        if (angle > largest_misalignment_rad)
            return fmt::format("axis {} of {} points {:.0f} deg away from where its rotation puts it: calibrate from a recording of this "
                               "system, or correct the rotation",
                               "xyz"[axis % axes_per_imu], imu.name, angle * 180 / std::numbers::pi);
    }
    return {};
}

void check_against_imus(const SourceSection& source, const ClusterDescription& calibrated, double interval_s, Report& report)
{
    if (const auto problem = problem_of(calibrated, source); !problem.empty()) report.at("source.calibration", problem);
    if (source.kind == SourceSection::Kind::ros2_imu && std::abs(calibrated.interval_s / interval_s - 1) > interval_tolerance)
        report.at("source.calibration",
                  fmt::format("holds for {:.4g} frames a second: state rate_hz: {:.4g}", 1 / calibrated.interval_s, 1 / calibrated.interval_s));
    for (const auto& [key, value] :
         {std::pair{"source.noise_rad", source.scenario.noise_rad}, std::pair{"source.quantum_rad", source.scenario.quantum}})
        if (value > 0) report.at(key, "is that of the calibration: leave it out, or the calibration");
}

}  // namespace

void take_mountings(const SourceSection& source, System& system, Report& report)
{
    if (system.sensor.cluster) report.at("source.kind", "the IMUs' mountings are the axes: leave unit.layout and unit.axes out");
    geometry::Axes axes(static_cast<Eigen::Index>(axes_per_imu * source.imus.size()), 3);
    std::vector<std::size_t> instrument;
    for (std::size_t i = 0; i < source.imus.size(); ++i) {
        // An IMU's axes in the body frame are the columns of its mounting.
        axes.middleRows<axes_per_imu>(static_cast<Eigen::Index>(axes_per_imu * i)) = mounting_of(source.imus[i]).matrix().transpose();
        instrument.insert(instrument.end(), axes_per_imu, i);
    }
    auto cluster = geometry::make_cluster(axes, instrument);
    if (!cluster) return report.at("source.imus", cluster.error());
    for (std::size_t i = 0; i < source.imus.size(); ++i) cluster->instrument_name[i] = source.imus[i].name;
    cluster->range.setConstant(system.sensor.range);
    system.sensor.cluster = std::move(*cluster);
}

void build_imus(const SourceSection& source, System& system, Report& report)
{
    Ros2SourceSettings settings;
    settings.skew_s = source.skew_s;
    const bool learns = system.sensor.kind == SensorKind::gyro && source.calibration.empty();
    settings.rest_s = source.rest_s.value_or(learns ? settings.rest_s : 0);
    if (settings.rest_s > 0 && system.sensor.kind != SensorKind::gyro)
        report.at("source.rest_s", "is for gyros: accelerometers measure gravity at rest");
    if (settings.rest_s > 0 && !source.calibration.empty())
        report.at("source.rest_s", "the biases are those of the calibration: leave one of both out");
    std::set<std::string> topics;
    for (std::size_t i = 0; i < source.imus.size(); ++i) {
        const auto& imu = source.imus[i];
        settings.imus.push_back({imu.topic, imu.name, mounting_of(imu).matrix(), Eigen::Vector3d(imu.position_m.data())});
        if (!imu.topic.empty() && !topics.insert(imu.topic).second)
            report.at(fmt::format("source.imus[{}].topic", i), fmt::format("two IMUs have the topic '{}'", imu.topic));
    }
    if (!source.imus.empty()) take_mountings(source, system, report);
    system.sensor.source.ros2 = std::move(settings);
}

void take_calibration(SourceSection& source, System& system, Report& report)
{
    if (source.calibration.empty()) return;
    source.calibration = beside(system, source.calibration);
    auto loaded = calibration::load_cluster(source.calibration);
    if (!loaded) return report.at("source.calibration", loaded.error());
    if (!source.imus.empty()) {
        check_against_imus(source, loaded->description, system.interval_s, report);
        auto cluster = geometry::make_cluster(loaded->description);
        if (!cluster) return report.at("source.calibration", cluster.error());
        if (system.sensor.range > 0) cluster->range.setConstant(system.sensor.range);
        system.sensor.cluster = std::move(*cluster);
    }
    system.sensor.source.calibration = std::move(*loaded);
}

}  // namespace quorient::system
