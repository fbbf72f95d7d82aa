#pragma once

#include "quorient/messages/codes.hpp"
#include "quorient/messages/identity.hpp"
#include "quorient/messages/limits.hpp"

#include <array>
#include <bit>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

namespace quorient::fdi {

/// One frame as a detector sees it.
struct Measurement {
    Identity identity;
    double interval_s = 0;
    std::span<const double> increment;      ///< z, one per axis of the cluster [rad; m/s]
    AxisMask valid = 0;                     ///< axes that claim a value in this frame
    std::span<const double> known_input{};  ///< e.g. the rudder angle [rad]

    /// The axis has a value that can be used. Whether it is to be trusted is another matter.
    bool usable(std::size_t axis) const { return has_axis(valid, axis) && axis < increment.size() && std::isfinite(increment[axis]); }

    /// Those of `axes` that are usable.
    AxisMask usable_of(AxisMask axes) const
    {
        AxisMask found = 0;
        for (AxisMask left = axes & valid; left != 0; left &= left - 1) {
            const auto axis = static_cast<std::size_t>(std::countr_zero(left));
            if (usable(axis)) found |= axis_bit(axis);
        }
        return found;
    }
};

/// What one frame says, before confirmation and latching.
enum class Outcome : std::uint8_t {
    warming_up,
    healthy,
    suspect,    ///< a fault, not attributable with confidence
    isolated,   ///< the faulty axes are named
    ambiguous,  ///< a fault, and the sets that explain it
    refused,    ///< the method's own rule gives no decision
    blind,      ///< the data contradict every hypothesis
};

/// What is wrong with one axis, and by how much.
struct AxisDiagnosis {
    Diagnosis kind = Diagnosis::none;
    double size = 0;        ///< in the unit of the diagnosis (codes.hpp)
    double sigma = 0;       ///< standard deviation of the size
    double bias = 0;        ///< whatever the diagnosis [rad/s]
    double bias_sigma = 0;  ///< its standard deviation
};

struct Assessment {
    Outcome outcome = Outcome::warming_up;
    AxisMask isolated = 0;                             ///< named axes; under `suspect` the likeliest culprit, if there is one
    std::array<AxisMask, max_candidates> candidate{};  ///< best first
    std::uint8_t candidate_count = 0;
    bool candidates_truncated = false;
    double statistic = 0;
    double threshold = 0;                     ///< in the statistic's unit
    std::uint64_t onset = never;              ///< first sequence that looks contaminated, where the method estimates it
    AxisMask provisional = 0;                 ///< contradicted in this frame: to be left out at once, though it may pass
    std::uint64_t provisional_from = never;   ///< first sequence to be left out
    AxisMask degraded = 0;                    ///< noisier or later than others, with no harm to the attitude
    std::array<AxisDiagnosis, max_axes> diagnosis{};  ///< for axes that are left out, named or excluded
    bool saturated = false;                   ///< all instruments are at their range: the rate is unknown, nobody is faulty
    std::array<double, max_axes> residual{};  ///< in the unit of the measurement
    std::array<double, max_axes> bound{};

    void add_candidate(AxisMask set)
    {
        if (candidate_count < max_candidates) candidate[candidate_count++] = set;
        else candidates_truncated = true;
    }
};

/// What a method with a model of the motion makes of an excluded axis in the newest frame.
struct Expectation {
    double value = 0;     ///< what the axis should have read [unit of the measurement]
    bool agrees = false;  ///< with the axis trusted again this frame, and as many before as the method looks at, would be healthy
};

/// A set of axes and what it is worth to the method.
struct ScoredSet {
    AxisMask axes = 0;
    double score = 0;
};

/// A figure of a method's own about its newest frame, for tools that show it. What does not exist is NaN, an empty string or `std::monostate`.
struct Detail {
    using Interval = std::array<double, 2>;
    struct Axes {
        AxisMask mask = 0;
    };
    using Value = std::variant<std::monostate, bool, std::int64_t, double, std::string, Axes, Interval, std::vector<bool>, std::vector<double>,
                               std::vector<std::string>, std::vector<Axes>, std::vector<Interval>, std::vector<ScoredSet>>;

    std::string_view name;
    Value value;
};

/// One detection method on one cluster. Frames come in order; nothing is allocated per frame.
class Detector {
public:
    virtual ~Detector() = default;

    /// Overwrites `assessment` whole. Axes outside `measurement.valid` and excluded axes are not used and never blamed.
    virtual void assess(const Measurement& measurement, Assessment& assessment) = 0;

    /// Works without these axes from the next frame on (all of them, not in addition to earlier ones).
    virtual void exclude(AxisMask excluded) = 0;

    /// How many further simultaneous axis faults can be detected with the axes that are left.
    virtual unsigned detectable_remaining() const = 0;

    /// What the method expects of an axis in the newest frame. @returns nothing where the method keeps no watch on excluded axes, or cannot say in this frame.
    virtual std::optional<Expectation> expectation(std::size_t) const { return std::nullopt; }

    /// The method's own figures of its newest frame, beside those of the assessment; one of the same name replaces it. Allocates.
    virtual std::vector<Detail> details(const Assessment&) const { return {}; }

    /// Why the newest assessment is `blind` or `warming_up`, where that has a reason of its own; else empty.
    virtual std::string_view reason() const { return {}; }

    /// Forgets everything learnt from earlier frames; exclusions stay.
    virtual void reset() {}
};

}  // namespace quorient::fdi
