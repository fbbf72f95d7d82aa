#pragma once

#include "quorient/configuration/table.hpp"
#include "quorient/simulation/motion.hpp"

#include <array>
#include <string>
#include <tl/expected.hpp>

namespace quorient::system {

/// `source.motion`: how the simulated body turns.
struct MotionSection {
    enum class Kind { rest, turn, coning, classic_coning, random };

    Kind kind = Kind::rest;
    simulation::Coning coning;
    double half_angle_deg = 1;
    double frequency_hz = 1;
    std::array<double, 3> rate_deg_s{0, 0, 6};
    double bandwidth_hz = 2;
    double rms_deg_s = 30;
    std::uint64_t seed = 1;
};

const configuration::Table<MotionSection>& motion_table();

/// @returns what is wrong with it, where no key shows it alone.
tl::expected<simulation::Motion, std::string> motion_of(const MotionSection& section);

}  // namespace quorient::system
