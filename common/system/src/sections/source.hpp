#pragma once

#include "motion.hpp"
#include "quorient/configuration/table.hpp"
#include "quorient/messages/unit_kind.hpp"
#include "quorient/simulation/simulated_instrument.hpp"
#include "quorient/simulation/vessel.hpp"
#include "quorient/system/plant.hpp"
#include "quorient/system/system.hpp"

#include <array>
#include <optional>
#include <string>
#include <vector>

namespace quorient::system {

/// One IMU of `source.imus`.
struct ImuSection {
    std::string topic;  ///< as DDS knows it
    std::string name;
    std::array<double, 4> rotation{1, 0, 0, 0};  ///< IMU frame -> body frame (w,x,y,z)
    std::array<double, 3> position_m{};          ///< in the body frame
};

/// `source`: where the frames come from.
struct SourceSection {
    enum class Kind { simulation, log, ros2_imu };

    SensorKind unit_kind = SensorKind::gyro;  ///< not a key: unit.kind
    Kind kind = Kind::simulation;
    std::optional<double> rate_hz;
    double speed = 1;
    std::vector<simulation::FaultSpec> faults;

    simulation::Scenario scenario;  ///< its figures
    std::optional<simulation::Quantize> quantize;
    MotionSection motion;

    std::vector<std::string> files;  ///< the log's, from the folder of the system file
    std::optional<double> rest_s;
    std::string calibration;
    double from_s = 0;
    std::optional<double> to_s;

    double skew_s = 0.02;
    std::vector<ImuSection> imus;

    simulation::VesselScenario vessel;  ///< its figures
    PlantSection plant;
};

const configuration::Table<SourceSection>& source_table();

/// `calibration`, for every source of real sensors.
configuration::Rows<SourceSection> calibration_row();

}  // namespace quorient::system
