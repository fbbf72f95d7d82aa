#pragma once

#include "quorient/calibration/calibration.hpp"
#include "quorient/fdi/array_sums.hpp"
#include "quorient/fdi/detector.hpp"
#include "quorient/geometry/sensor_cluster.hpp"

#include <functional>
#include <vector>

namespace quorient::calibration {

/// Half of a recording's motion, with the calibration that the other half gives (and the resting segments, shared out as the motion is):
/// what calibration leaves wrong shows in it, as it will show in the next recording.
struct HeldOut {
    /// Samples [begin, end) move; from `lead` on the sensors are watched, for windows reach back.
    struct Stretch {
        std::size_t lead = 0;
        std::size_t begin = 0;
        std::size_t end = 0;
    };

    geometry::SensorCluster cluster;
    CalibratedCluster calibration;
    std::vector<Stretch> stretches;

    /// Hands every sample of a stretch over as a detector sees it.
    void play(Samples samples, const Stretch& stretch,
              const std::function<void(std::size_t, const fdi::Measurement&)>& take) const;
};

/// Stretches without rest by turns; one longer than 20 s is cut in two.
/// @returns two halves, or none where a half cannot be calibrated alone.
std::vector<HeldOut> held_out_halves(Samples samples, const ClusterDescription& nominal,
                                     const std::vector<Segment>& rest, const RestSettings& settings = {});

}  // namespace quorient::calibration
