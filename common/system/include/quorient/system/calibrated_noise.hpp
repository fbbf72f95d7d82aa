#pragma once

#include "quorient/calibration/cluster_file.hpp"
#include "quorient/fdi/settings.hpp"

#include <optional>

namespace quorient::system {

/// The noise of the accumulating detector's gated sums as a calibration found it; nothing where it found none.
std::optional<fdi::GatedNoise> gated_noise_of(const calibration::CalibratedCluster& cluster);

}  // namespace quorient::system
