#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

namespace quorient {

/// Steady-clock stamps [ns] of one frame's way through the pipeline. The sensor fills in its own always, the others are 0 where not asked for.
/// Comparable on one host only.
using Stamps = std::array<std::int64_t, 8>;

enum class Hop : std::size_t { sensor = 0, detector_in, detector_out, integrator_in, integrator_out, voter_in, voter_out };

}  // namespace quorient
