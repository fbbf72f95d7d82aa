#pragma once

#include "field/accusations.hpp"
#include "field/axis_diagnosis.hpp"
#include "field/compared_frames.hpp"
#include "field/disagreement.hpp"
#include "field/presence.hpp"
#include "skewed/axis_comparison.hpp"
#include "skewed/axis_filters.hpp"
#include "skewed/axis_saturation.hpp"
#include "skewed/axis_start.hpp"
#include "skewed/skewed_detector.hpp"

namespace quorient::fdi {

/// The order of things in one frame, as FieldDetector::State.
class SkewedDetector::State final : public SkewedDetector {
public:
    State(geometry::SensorCluster cluster, const DetectorSettings& settings, const FieldRules& rules);

    void assess(const Measurement& measurement, Assessment& assessment) override;
    void exclude(AxisMask excluded) override;
    unsigned detectable_remaining() const override;
    std::string_view reason() const override;
    void reset() override;
    double largest_lasting() const override { return largest_lasting_; }

private:
    using AxisSet = skewed::AxisSet;

    /// A frame with its rate, waiting for its successor.
    struct Pending {
        skewed::AxisFrame frame;
        skewed::PerAxis rates{};
        AxisSet present;  ///< compared, with data, within the range
        Eigen::Vector3d rate;
    };

    /// What is said of an accused axis.
    struct Accused {
        field::AxisFit fit;
        Diagnosis blamed_for = Diagnosis::none;
        AxisDiagnosis diagnosis;
    };

    void advance(const skewed::AxisFrame& frame);
    void start_with(const skewed::AxisFrame& frame);
    void take_in(const skewed::AxisFrame& frame);
    void compare();
    void judge(const field::Suspicions& found);
    void judge_last_parity();
    void check_erratic();
    void check_class();
    std::optional<std::size_t> outside_class(Eigen::Index parameter, const skewed::PerAxis& residual, const skewed::AxisParity& parity) const;
    void disagree(AxisSet candidates, std::size_t window);
    void leave_out(const field::Suspicion& suspicion);
    void name(std::size_t axis, std::uint64_t onset, Diagnosis why);
    void accuse(std::size_t axis, Diagnosis why);
    void acquit(std::size_t axis);
    void diagnose();
    void fit(std::size_t axis);
    void forget_learned();
    bool may_learn() const;
    AxisSet comparable() const;
    const skewed::AxisParity& parity_of(AxisSet set);
    std::uint64_t frames_in(double seconds) const;
    void report(const Measurement& measurement, Assessment& assessment) const;

    geometry::SensorCluster cluster_;
    FieldRules rules_;
    const ClassFigures& figures_;
    skewed::AxisFrames framing_;
    field::Presence presence_;
    skewed::AxisStart start_;
    skewed::AxisSaturation saturation_;
    skewed::AxisComparison comparison_;
    skewed::AxisFilters filters_;
    field::Accusations accusations_;
    skewed::AxisParity parity_;  ///< for the latest set

    AxisSet excluded_;
    field::ThreeFrames<Pending> pending_;
    Eigen::Vector3d last_rate_ = Eigen::Vector3d::Zero();
    bool learning_begun_ = false;
    std::uint64_t learning_from_ = 0;  ///< sequence
    std::uint64_t last_sequence_ = 0;

    field::ComparedFrames history_;
    std::array<Accused, max_axes> accused_{};
    double disturbance_ = 0;
    double certainty_ = 0;  ///< the largest of the newest frame
    double largest_lasting_ = 0;
    AxisSet candidates_;    ///< that explain the present disagreement alike
    field::Disagreement disagreement_;
};

}  // namespace quorient::fdi
