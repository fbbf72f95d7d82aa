#pragma once

#include "quorient/fdi/observer_detector.hpp"
#include "vessel_input.hpp"

#include <Eigen/Core>
#include <cstdint>
#include <functional>
#include <string>
#include <vector>

namespace quorient::cli {

struct VesselOptions {
    std::string file;
    std::string scheme;
    std::vector<std::string> faults;
    double interval_s = 0.01;
    double duration_s = 80;
    double noise = 0;
    std::uint64_t seed = 1;
    std::string plot_file;
    bool force = false;
    bool gains = false;
    bool table = false;
    bool json = false;
};

/// One sample of the run.
struct VesselRow {
    double time_s = 0;
    double rudder_rad = 0;
    Eigen::VectorXd state;
    Eigen::VectorXd sample;                 ///< with noise and faults
    std::vector<Eigen::VectorXd> residual;  ///< each channel's observer's
    std::vector<double> metric;             ///< likewise
    fdi::Assessment assessment;
};

/// Plays the scenario through one scheme's detector, sample by sample, until its end or until `see` returns false.
/// Ends the verb with the reason where the options, the plant or the observers cannot be.
void play(const VesselOptions& options, const VesselInput& input, fdi::ObserverScheme scheme,
          const std::function<bool(const VesselRow&)>& see);

}  // namespace quorient::cli
