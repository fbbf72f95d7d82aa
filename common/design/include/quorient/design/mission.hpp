#pragma once

#include "quorient/design/executor.hpp"
#include "quorient/design/figures.hpp"

#include <string>
#include <tl/expected.hpp>

namespace quorient::design {

/// Plays missions: parts fail at random times, and at each failure the real method (fdi::FaultMonitor: detector and verdict machine) gets
/// frames of noise and the fault. The mission goes on where it isolates what has failed and nothing else, and three directions are left.
///
/// Only missions with a failure are played; the probability of those without one is exact. A failed shared part takes its instruments'
/// data away, which needs no redundancy to be seen. On four axes the frames hold a motion (1000 sigma a frame, turning by 0.005 rad),
/// which `vector` has to predict; other methods are blind to motion. Three axes know nothing of a fault: the first failure ends it.
///
/// The result depends on seed and trials, not on the executor.
/// @returns why the mission's method cannot serve this cluster.
tl::expected<Survival, std::string> survival(const geometry::SensorCluster& cluster, const Mission& mission, std::uint64_t seed,
                                             const ForEach& for_each = in_turn);

}  // namespace quorient::design
