#pragma once

#include "quorient/configuration/table.hpp"
#include "quorient/fdi/observer_bank.hpp"
#include "quorient/simulation/vessel.hpp"

#include <optional>
#include <string>
#include <tl/expected.hpp>
#include <vector>

namespace quorient::system {

// How files write linear plants and the poles of their observers.

/// `vessel: {mass: 15, …}` or `plant: {A: [[…]], B: [[…]], C: [[…]]}`; with neither, paper 001's vessel.
struct PlantSection {
    std::optional<simulation::VesselCoefficients> vessel;
    std::optional<fdi::LinearPlant> plant;  ///< C is empty where it was left out

    bool any() const { return vessel || plant; }
};

configuration::Rows<PlantSection> plant_rows();

/// What is wrong with a plant, and the key that has it.
struct PlantProblem {
    std::string key;
    std::string what;  ///< empty where reading the key has reported it
};

/// @returns the model of a section; C is the identity where it was left out.
tl::expected<simulation::VesselModel, PlantProblem> model_of(const PlantSection& section);

/// One list of poles for each channel, or a single one for all; a pole is a number, or `[real, imaginary]` for a conjugate pair.
void read_poles(configuration::Section& section, const std::string& key, std::vector<fdi::Poles>& poles);
YAML::Node poles_node(const std::vector<fdi::Poles>& poles);

template <class Owner>
configuration::Rows<Owner> poles(configuration::Key key, std::vector<fdi::Poles> Owner::*member)
{
    key.form = "list of poles for each channel, or one for all; a pole is a number, or [real, imaginary] for a conjugate pair";
    return configuration::own<Owner>(
        key, [name = key.name, member](configuration::Section& section, Owner& values) { read_poles(section, name, values.*member); },
        [member](const Owner& values) { return poles_node(values.*member); });
}

}  // namespace quorient::system
