#pragma once

#include "quorient/fdi/linear_plant.hpp"
#include "quorient/runtime/yaml.hpp"
#include "quorient/simulation/vessel.hpp"

#include <vector>

namespace quorient::system {

// How files write linear plants and the poles of their observers. What is wrong is told at its key.

/// `vessel: {mass: 15, …}` (the paper's where left out) or `plant: {A: [[…]], B: [[…]], C: [[…]]}` (C: identity where left out), under
/// `section`. @returns false, and leaves `model` as it was, where what the file says is no model.
bool parse_plant(runtime::Section& section, simulation::VesselModel& model);

/// One list of poles for each channel, or a single one for all; a pole is a number, or `[real, imaginary]` for a conjugate pair.
void parse_poles(runtime::Section& section, const char* key, std::vector<fdi::Poles>& poles);

}  // namespace quorient::system
