#pragma once

#include "arrays/accumulating_detector.hpp"
#include "field/noise_scale.hpp"

#include <memory>
#include <optional>

namespace quorient::fdi::field {

/// Where a calibration has measured what motion does to the array, `accumulating` finds small faults in violent motion two to four times sooner. What it
/// names is left out at once; the field detector latches. It is believed only while the noise measured online confirms the calibration's:
/// static noise and the part that motion brings, both at most twice what the calibration says.
class FastLane {
public:
    /// @returns nothing where no calibration has measured the motion noise, or the method does not carry the array.
    static std::optional<FastLane> make(const DetectorSettings& settings, const geometry::SensorCluster& cluster);

    void assess(const Measurement& measurement);
    void exclude(AxisMask excluded) { detector_->exclude(excluded); }
    void reset();

    /// What it has named in two of the last three frames, while the noise confirms it.
    struct Finding {
        AxisMask axes;
        std::uint64_t onset;
    };
    std::optional<Finding> finding(const NoiseScale& noise, InstrumentSet compared) const;

private:
    FastLane(std::unique_ptr<AccumulatingDetector> detector, double standing, double moving);

    std::unique_ptr<AccumulatingDetector> detector_;
    double standing_;  ///< largest variances of one frame that confirm the calibration: at rest [(rad/s)^2] …
    double moving_;    ///< … and in units of what motion makes
    Assessment assessment_;
    std::array<AxisMask, 3> named_{};  ///< newest first
};

}  // namespace quorient::fdi::field
