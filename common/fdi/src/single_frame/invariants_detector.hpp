#pragma once

#include "single_frame/frame_detector.hpp"
#include "quorient/fdi/settings.hpp"

#include <Eigen/Core>
#include <memory>
#include <span>
#include <string>
#include <tl/expected.hpp>
#include <vector>

namespace quorient::fdi {

/// Invariants: every four axes have one combination that the motion cannot change. [paper 002]
///
/// For each quadruple of rank 3, v (unit norm) with v'H = 0 on its rows; it passes iff |v'z| <= T. The set of quadruples that pass is
/// the decision, see exact_pattern; any other pattern is `refused`.
///
/// Relaxed: where the strict rule refuses, take the K axes without which the worst ratio |v'z| / T is smallest (K the most faults
/// allowed: on six axes, the complement of the quadruple with the smallest ratio), and exclude them if that ratio passes. This is the
/// paper's rule, setting `bare`. Without it, sets of one axis are tried first, then of two and so on; where several of the smallest size pass, the frame
/// is `ambiguous` with all of them.
///
/// For 6 to 24 axes; after exclusions with whatever is left. Without a tolerance, T_v is that of noise,
/// z(1 - pfa / 2m) sqrt(sum v_i^2 sigma_i^2) over m quadruples.
/// Not guaranteed: a refusal does not distinguish a third fault from noise just above T.
class InvariantsDetector final : public FrameDetector {
public:
    /// Settings: tolerance (else sigma and pfa), max_faults (default 2), relaxed, bare.
    static tl::expected<std::unique_ptr<InvariantsDetector>, std::string> make(const DetectorSettings& settings,
                                                                       const geometry::SensorCluster& cluster);

    /// In the last frame: |v'z| of each quadruple in lexicographic order, coplanar quadruples left out; and whether it passes.
    std::span<const double> values() const { return values_; }
    std::span<const std::uint8_t> passed() const { return passed_; }

    std::vector<Detail> details(const Assessment& assessment) const override;

private:
    struct Quadruple {
        std::array<std::uint8_t, 4> axis{};
        Eigen::Vector4d weight;  ///< v
        double tolerance = 0;
    };

    InvariantsDetector(const DetectorSettings& settings, const geometry::SensorCluster& cluster, geometry::AxisVector sigma);

    void form(AxisMask working) override;
    void judge(const geometry::AxisVector& z, Assessment& assessment) override;
    void set_tolerances();
    double worst_ratio_without(AxisMask without) const;
    AxisMask best_exclusion() const;
    void relax(Assessment& assessment) const;

    unsigned allowed_faults() const;

    double tolerance_;  ///< configured, or 0
    double pfa_;
    unsigned max_faults_;
    bool relaxed_;
    bool bare_;
    geometry::AxisVector sigma_;

    std::vector<Quadruple> quadruples_;
    std::vector<AxisMask> reads_;
    std::vector<double> values_;
    std::vector<std::uint8_t> passed_;
    double largest_tolerance_ = 0;
    geometry::AxisMatrix projector_;
};

}  // namespace quorient::fdi
