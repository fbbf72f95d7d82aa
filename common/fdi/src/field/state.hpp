#pragma once

#include "field/accusations.hpp"
#include "field/compared_frames.hpp"
#include "field/comparison.hpp"
#include "field/diagnostics.hpp"
#include "field/disagreement.hpp"
#include "field/fast_lane.hpp"
#include "field/field_detector.hpp"
#include "field/framing.hpp"
#include "field/matched_filters.hpp"
#include "field/presence.hpp"
#include "field/saturation.hpp"
#include "field/start.hpp"

namespace quorient::fdi {

/// The order of things in one frame; each of them is a class of its own.
class FieldDetector::State final : public FieldDetector {
public:
    State(geometry::SensorCluster cluster, const InstrumentArray& array, const DetectorSettings& settings, const FieldRules& rules);

    void assess(const Measurement& measurement, Assessment& assessment) override;
    void exclude(AxisMask excluded) override;
    unsigned detectable_remaining() const override;
    std::string_view reason() const override;
    void reset() override;
    double largest_lasting() const override { return largest_lasting_; }

private:
    using InstrumentSet = field::InstrumentSet;
    using Suspicion = field::Suspicion;

    /// A frame with its consensus, waiting for its successor.
    struct Pending {
        field::Frame frame;
        field::Comparison::Rates rates;
        InstrumentSet present;  ///< compared, and with data
        Eigen::Vector3d consensus;
    };

    /// Why an instrument is reported as degraded, and until which frame count.
    struct Degraded {
        Diagnosis why = Diagnosis::none;
        std::uint64_t until = 0;
    };

    /// An instrument that was at its range while others were not: since which sequence, and until which frame count it is left out.
    struct Limited {
        std::uint64_t onset = never;
        std::uint64_t until = 0;
        AxisMask axes = 0;  ///< those that were at their range
    };

    void advance(const field::Frame& frame);
    void start_with(const field::Frame& frame);
    InstrumentSet comparable() const;
    void take_in(const field::Frame& frame);
    void compare();
    void judge(const field::Suspicions& found);
    void judge_two(InstrumentSet two);
    void contradict(const Suspicion& suspicion);
    void forget_learned();
    void name(std::size_t m, std::uint64_t onset, const field::Blame& blame);
    void degrade(std::size_t m, Diagnosis why);
    void follow_fast_lane();
    void leave_out(std::size_t m, std::uint64_t onset, std::uint64_t frames, const field::Blame& blame);
    void limit();
    bool is_limited(std::size_t m) const { return history_.count() > 0 && history_.count() <= limited_[m].until; }
    std::uint64_t onset_of(std::size_t m, std::size_t window) const;
    std::uint64_t frames_in(double seconds) const;
    void diagnose();
    void check_erratic();
    void check_class();
    bool may_learn() const;
    void report(const Measurement& measurement, Assessment& assessment) const;
    void report_limited(Assessment& assessment) const;
    void report_degraded(Assessment& assessment) const;
    void report_residuals(const Measurement& measurement, Assessment& assessment) const;
    AxisMask axes_of(InstrumentSet instruments) const;

    geometry::SensorCluster cluster_;
    InstrumentArray array_;
    FieldRules rules_;
    Mount mount_;
    ClassFigures figures_;
    field::Framing framing_;
    field::Presence presence_;
    field::Start start_;
    field::Saturation saturation_;
    field::Comparison comparison_;
    field::MatchedFilters filters_;
    field::Diagnostics diagnostics_;
    std::optional<field::FastLane> fast_lane_;

    AxisMask excluded_axes_ = 0;
    InstrumentSet excluded_;
    field::ThreeFrames<Pending> pending_;
    Eigen::Vector3d last_consensus_ = Eigen::Vector3d::Zero();
    bool learning_begun_ = false;
    std::uint64_t learning_from_ = 0;  ///< sequence
    std::uint64_t last_sequence_ = 0;

    field::ComparedFrames history_;
    field::Accusations accusations_;
    std::array<Degraded, field::max_instruments> degraded_{};
    std::array<Limited, field::max_instruments> limited_{};
    double disturbance_ = 0;
    double certainty_ = 0;             ///< the largest of the newest frame
    double largest_lasting_ = 0;
    field::Disagreement disagreement_;
};

}  // namespace quorient::fdi
