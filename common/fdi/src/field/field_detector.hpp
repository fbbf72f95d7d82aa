#pragma once

#include "quorient/fdi/detector.hpp"
#include "quorient/fdi/settings.hpp"
#include "quorient/geometry/sensor_cluster.hpp"

#include <memory>
#include <string>
#include <tl/expected.hpp>

namespace quorient::fdi {

/// The rules of the field detector. Each can be switched off, to see what it is worth.
struct FieldRules {
    bool learning = true;           ///< slow differences between instruments are learned
    bool persistence = true;        ///< a contradiction latches only in three of four quarters of its window
    bool others_must_agree = true;  ///< the others' own scatter in a window protects the accused
    bool leave_one_out = true;      ///< an instrument is judged by the noise of the others
    bool clipping = true;           ///< one frame counts no more than a multiple of its standard deviation
    bool dead_zone = true;          ///< rates that are noise are no motion
    bool smallest_angle = true;     ///< what cannot matter to the attitude excludes nothing
    bool erratic = true;            ///< an instrument that is off in a third of its frames
    bool outside_class = true;      ///< a resting start and what is learned stay within the class
    bool fast_lane = true;          ///< where a calibration has measured the motion noise, `accumulating` may leave an instrument out
    bool brief_gains = true;        ///< on one rigid block, a gain that shows in a short window leaves an instrument out
    bool saturation = true;         ///< beyond its range an axis knows nothing
};

/// Finds faulty instruments among three or more that each measure all three directions, on arrays that nobody has calibrated: the default of
/// `auto`. Where a class of sensors stands in the settings, nothing is tuned. Method, constants, limits: common/fdi/README.md.
///
/// Says of every frame
/// - suspect, with `provisional`: one instrument contradicts the others beyond noise and allowances; it may pass;
/// - isolated: whole instruments, the contradiction has lasted; repeated until they are excluded;
/// - ambiguous, with both candidates: two instruments are left, and they disagree;
/// - warming_up: the first second, and while fewer than two instruments deliver data.
/// statistic = the largest certainty, threshold 1.
///
/// Instruments without data are left out while they have none. Each frame waits for its successor: one frame of delay (up to 10 ms more where
/// the sampling rate exceeds 125 Hz, see Framing). Nothing is allocated per frame.
class FieldDetector : public Detector {
public:
    /// Uses settings.sensor_class, mount, calibrated, delay_class_s.
    /// @returns why not: fewer than two instruments, an instrument that does not span space, an unknown interval.
    static tl::expected<std::unique_ptr<FieldDetector>, std::string> make(const DetectorSettings& settings,
                                                                         const geometry::SensorCluster& cluster,
                                                                         const FieldRules& rules = {});

    /// The largest certainty of any lasting contradiction so far: how close sound instruments came to 1.
    virtual double largest_lasting() const = 0;

private:
    class State;
};

}  // namespace quorient::fdi
