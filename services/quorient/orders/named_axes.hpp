#pragma once

#include "quorient/messages/cluster_description.hpp"
#include "quorient/messages/limits.hpp"

#include <tl/expected.hpp>
#include <string>
#include <string_view>
#include <vector>

namespace quorient::cli {

/// Axes as users name them, divided by commas or plus signs: "IMU3 y, 2" is {"IMU3 y", "2"}.
std::vector<std::string> axis_words(std::string_view text);

/// Whether a word is a number, and so needs no description.
bool is_axis_number(std::string_view word);

/// A word is a 0-based number, an axis's name ("IMU3 y", "G2"), or the name of an instrument, which stands for all its axes.
/// A number wins over a name. @returns what is wrong: an unknown name, with those that there are, or a number above those of any unit.
tl::expected<AxisMask, std::string> named_axes(const std::vector<std::string>& words, const ClusterDescription& description);

}  // namespace quorient::cli
