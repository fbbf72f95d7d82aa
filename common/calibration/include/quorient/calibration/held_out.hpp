#pragma once

#include "quorient/calibration/calibration.hpp"
#include "quorient/fdi/array_sums.hpp"
#include "quorient/fdi/detector.hpp"
#include "quorient/geometry/sensor_cluster.hpp"

#include <functional>
#include <vector>

namespace quorient::calibration {

/// Half of a recording's motion, with the calibration from the other half (resting segments are divided in the same way).
/// The remaining errors of a calibration show in it as they will show in the next recording.
struct HeldOut {
    /// The sensors move in samples [begin, end). Playing begins at `lead`, because windows reach back.
    struct Stretch {
        std::size_t lead = 0;
        std::size_t begin = 0;
        std::size_t end = 0;
    };

    geometry::SensorCluster cluster;
    CalibratedCluster calibration;
    std::vector<Stretch> stretches;

    /// Calls `take` with every sample of a stretch, corrected as for a detector.
    void play(Samples samples, const Stretch& stretch,
              const std::function<void(std::size_t, const fdi::Measurement&)>& take) const;
};

/// Divides the stretches without rest alternately; one longer than 20 s is cut in two.
/// @returns two halves, or none where a half cannot be calibrated alone.
std::vector<HeldOut> held_out_halves(Samples samples, const ClusterDescription& nominal,
                                     const std::vector<Segment>& rest, const RestSettings& settings = {});

}  // namespace quorient::calibration
