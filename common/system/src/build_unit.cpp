#include "build.hpp"
#include "quorient/attitude/levelling.hpp"
#include "quorient/geometry/layouts.hpp"
#include "quorient/messages/units.hpp"
#include "quorient/system/axes_file.hpp"

#include <fmt/format.h>

namespace quorient::system {

namespace {

tl::expected<geometry::SensorCluster, std::string> cluster_of(UnitSection& unit, const System& system)
{
    if (unit.axes) return geometry::make_cluster(*unit.axes);
    if (unit.axes_file.empty()) return geometry::layout(*unit.layout);
    unit.axes_file = beside(system, unit.axes_file);
    return load_axes_file(unit.axes_file);
}

void build_cluster(UnitSection& unit, System& system, Report& report)
{
    const bool has_axes = unit.axes || !unit.axes_file.empty();
    if (!unit.layout && !has_axes) return;
    if (unit.layout && has_axes) return report.at("unit.axes", "states the axes, as unit.layout does: keep one of them");
    auto cluster = cluster_of(unit, system);
    if (!cluster) return report.at(has_axes ? "unit.axes" : "unit.layout", cluster.error());
    system.sensor.cluster = std::move(*cluster);
    system.sensor.cluster->range.setConstant(system.sensor.range);
}

void build_initial_attitude(const InitialAttitudeSection& file, SensorSettings& sensor, Report& report)
{
    sensor.initial_attitude = file.stated;
    if (!file.heading_deg) return;
    const double heading_rad = *file.heading_deg * degree;
    if (!file.specific_force_m_s2) {
        sensor.levelled_heading_rad = heading_rad;
        return;
    }
    const auto attitude = attitude::level(Eigen::Vector3d(file.specific_force_m_s2->data()), heading_rad);
    if (attitude) sensor.initial_attitude = attitude::to_array(*attitude);
    else report.at("unit.initial_attitude.specific_force_m_s2", attitude.error());
}

void build_vessel(UnitSection& unit, System& system, Report& report)
{
    if (!unit.channels && !unit.plant.plant) unit.channels = {"sway_velocity", "yaw_rate"};
    if (unit.channels) system.channels = *unit.channels;
    const auto model = model_of(unit.plant);
    if (!model) {
        if (!model.error().what.empty()) report.at("unit." + model.error().key, model.error().what);
        return;
    }
    system.vessel = *model;
    if (!system.channels.empty() && system.channels.size() != static_cast<std::size_t>(model->c.rows()))
        report.at("unit.channels", fmt::format("{} names for {} channels", system.channels.size(), model->c.rows()));
}

}  // namespace

void build_unit(File& file, System& system, Report& report)
{
    auto& unit = file.unit;
    if (!unit.name) unit.name = fmt::format("unit {}", unit.id);
    system.unit = unit.id;
    system.sensor.unit_name = *unit.name;
    system.sensor.kind = unit.kind;
    system.sensor.range = unit.kind == SensorKind::gyro ? unit.range_deg_s * degree : unit.range_m_s2;
    if (unit_kind(unit.kind).has_model) return build_vessel(unit, system, report);
    build_cluster(unit, system, report);
    build_initial_attitude(unit.initial_attitude, system.sensor, report);
}

}  // namespace quorient::system
