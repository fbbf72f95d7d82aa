#pragma once

#include "quorient/fdi/observer_bank.hpp"
#include "quorient/simulation/vessel.hpp"

#include <string>
#include <tl/expected.hpp>
#include <vector>

namespace quorient::cli {

/// A plant with its observers, as a file says it; what the file leaves out is the paper's.
struct VesselInput {
    simulation::VesselModel model;
    std::vector<fdi::Poles> directional_poles{{-3, -4}, {-0.5, -4}};  ///< for each channel: along its fault, other
    std::vector<fdi::Poles> blind_poles{{-3, -4}};                    ///< for each channel, or one set for all
    std::vector<double> sigma;
    double model_error = 0;
    double false_alarm_probability = fdi::default_false_alarm_probability;
    std::optional<double> threshold;  ///< without sigma: 1e-3

    fdi::ObserverSettings observers(fdi::ObserverScheme scheme) const;
};

/// The vessel of paper 001 where `file` is empty. @returns every problem of the file, each with file:line:column.
tl::expected<VesselInput, std::string> load_vessel(const std::string& file);

}  // namespace quorient::cli
