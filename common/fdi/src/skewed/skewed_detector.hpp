#pragma once

#include "field/field_detector.hpp"

namespace quorient::fdi {

/// The field detector of arrays of five or more single axes in skewed directions, that nobody has calibrated: the rules of FieldDetector, with
/// a single axis in the place of an instrument, and its parity in the place of a difference. Method, limits: docs/methods/field.md.
///
/// Says of every frame
/// - suspect, with `provisional`: one axis contradicts the others beyond noise and allowances; it may pass;
/// - isolated: single axes, the contradiction has lasted; repeated until they are excluded;
/// - ambiguous: several axes explain a lasting contradiction alike; with four axes left, all of them;
/// - warming_up: the first second, and while fewer than four axes deliver data.
/// statistic = the largest certainty, threshold 1. Otherwise as FieldDetector.
class SkewedDetector : public Detector {
public:
    static constexpr std::size_t least_axes = 5;

    /// Uses settings.sensor_class, calibrated, delay_class_s.
    /// @returns why not: fewer than five axes, an unknown interval, a mount of separate boxes.
    static tl::expected<std::unique_ptr<SkewedDetector>, std::string> make(const DetectorSettings& settings, const geometry::SensorCluster& cluster,
                                                                          const FieldRules& rules = {});

    /// The largest certainty of any lasting contradiction so far: how close sound axes came to 1.
    virtual double largest_lasting() const = 0;

private:
    class State;
};

}  // namespace quorient::fdi
