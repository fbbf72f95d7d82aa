#pragma once

#include "quorient/geometry/sensor_cluster.hpp"
#include "quorient/settings/setting.hpp"

#include <array>
#include <cstdint>
#include <string>

namespace quorient::attitude {

/// What a user can set of it is explained by integrator_record().
struct IntegratorSettings {
    std::string algorithm = "window-10";  ///< as in `quorient propagate`, see update.hpp
    double history_s = 10;
    bool rollback = true;
    std::array<double, 4> initial_attitude{1, 0, 0, 0};  ///< q_RB at the start of sequence 0 (w,x,y,z)
    double initial_sigma_rad = 0;
    bool initialised = true;  ///< false: mode INITIALISING until a voted attitude or a reset
    bool leave_out_suspects = true;
    double lost_after_s = 1;
    std::uint32_t unit = 0;
    std::uint32_t lane = 0;
};

/// What a user can set beside the algorithm.
settings::Record<IntegratorSettings> integrator_record();

/// The longest history that is kept, at this interval.
double longest_history_s(double interval_s);

/// @returns what is wrong with the settings or the cluster, beside the algorithm's name; empty if nothing is.
std::string problem_of(const IntegratorSettings& settings, const geometry::SensorCluster& cluster);

}  // namespace quorient::attitude
