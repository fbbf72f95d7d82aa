#pragma once

#include "quorient/configuration/table.hpp"
#include "quorient/geometry/sensor_cluster.hpp"
#include "quorient/messages/unit_kind.hpp"
#include "quorient/system/plant.hpp"

#include <array>
#include <optional>
#include <string>
#include <vector>

namespace quorient::system {

/// Where the attitude begins.
struct InitialAttitudeSection {
    std::optional<std::array<double, 4>> stated;                 ///< q_RB (w,x,y,z)
    std::optional<double> heading_deg;                           ///< levelled by accelerometers at rest, with this heading …
    std::optional<std::array<double, 3>> specific_force_m_s2{};  ///< … by these values in place of the log's, body frame
};

/// `unit`: what is measured, and by which axes.
struct UnitSection {
    std::uint32_t id = 0;
    std::optional<std::string> name;
    SensorKind kind = SensorKind::gyro;

    std::optional<std::string> layout;
    std::optional<geometry::Axes> axes;
    std::string axes_file;  ///< in place of both
    double range_deg_s = 0;
    double range_m_s2 = 0;
    InitialAttitudeSection initial_attitude;

    PlantSection plant;
    std::optional<std::vector<std::string>> channels;
    bool rudder = true;  ///< the known input; there is no other
};

const configuration::Table<UnitSection>& unit_table();

}  // namespace quorient::system
