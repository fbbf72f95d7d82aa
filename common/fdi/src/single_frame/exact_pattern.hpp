#pragma once

#include "quorient/messages/limits.hpp"

#include <cstdint>
#include <optional>
#include <span>

namespace quorient::fdi {

/// The decision rule that invariants and voting share: many comparisons, each over some axes, and a set w of faulty axes shows as the
/// pattern in which *exactly* the comparisons without any axis of w pass. [paper 002: 5 of 15 quadruples or 45 of 190 triad pairs for
/// one of six axes, 1 or 6 for two; C(n-k, 4) and the pairs of C(n-k, 3) in general]
///
/// @param reads   the axes that each comparison really depends on (a zero coefficient does not count)
/// @param passed  whether it passes, as many
/// @returns w, empty where all pass; nothing where no set of at most max_faults axes gives this pattern, or more than one would.
std::optional<AxisMask> exact_pattern(std::span<const AxisMask> reads, std::span<const std::uint8_t> passed, unsigned max_faults);

}  // namespace quorient::fdi
