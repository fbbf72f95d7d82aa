#pragma once

#include "detector.hpp"
#include "quorient/configuration/table.hpp"
#include "quorient/system/system.hpp"

#include <string>

namespace quorient::system {

/// `lanes[].integrator`.
struct IntegratorSection {
    attitude::IntegratorSettings integration;
    double patience = 0.2;
};

/// One of `lanes`.
struct LaneSection {
    std::string name;
    ProcessSettings process;
    SensorKind unit_kind = SensorKind::gyro;  ///< not a key: unit.kind
    DetectorSection detector;
    IntegratorSection integrator;
};

/// One of `voters`.
struct VoterSection {
    std::string name;
    ProcessSettings process;
};

/// `sensor`: the process that publishes frames.
struct SensorSection {
    ProcessSettings process;
    double wait_s = 5;
};

const configuration::Table<LaneSection>& lane_table();
const configuration::Table<VoterSection>& voter_table();
const configuration::Table<SensorSection>& sensor_table();

}  // namespace quorient::system
