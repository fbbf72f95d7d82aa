#pragma once

#include "quorient/configuration/section.hpp"

#include <array>
#include <optional>
#include <string>
#include <string_view>

namespace quorient::system {

/// What a rotation may be written as, for the reference page.
inline constexpr std::string_view rotation_form =
    "quaternion [w, x, y, z], three rows of a matrix, or {roll_deg, pitch_deg, yaw_deg} (turned about z, then y, then x)";

/// A rotation (w, x, y, z) under a key. One that is off by no more than 1e-3 is normalised; any other is a problem that states the norm.
/// @returns nothing where the key is absent or wrong.
std::optional<std::array<double, 4>> read_rotation(configuration::Section& section, const std::string& key);

YAML::Node rotation_node(const std::array<double, 4>& rotation);

}  // namespace quorient::system
