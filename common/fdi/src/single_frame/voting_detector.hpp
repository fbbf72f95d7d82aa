#pragma once

#include "single_frame/frame_detector.hpp"
#include "quorient/fdi/settings.hpp"
#include "quorient/geometry/triads.hpp"

#include <Eigen/Core>
#include <memory>
#include <string>
#include <tl/expected.hpp>
#include <vector>

namespace quorient::fdi {

/// Voting: every three axes that span space give an estimate x_T = H_T^-1 z_T, and every two estimates are compared. [paper 002]
///
/// A pair passes iff |x_T - x_T'| <= T (Euclidean norm). The set of pairs that pass is the decision, see exact_pattern; any other pattern
/// is `refused`. For 6 to 24 axes (12 or more are slow: the pairs grow with n^6); after exclusions with whatever is left.
///
/// Without a tolerance, a pair may differ by the sum of its two triads' radii, the radius of a triad being that of the ball that holds its
/// error with probability 1 - pfa / (number of triads): sqrt(largest eigenvalue of its covariance x chi-square of 3 degrees).
/// Not guaranteed: the weakest triad decides what can be seen, so soft faults are refused or missed that parity isolates.
class VotingDetector final : public FrameDetector {
public:
    /// Settings: tolerance (else sigma and pfa), max_faults (default 2).
    static tl::expected<std::unique_ptr<VotingDetector>, std::string> make(const DetectorSettings& settings,
                                                                   const geometry::SensorCluster& cluster);

    /// Pairs that passed in the last frame.
    std::size_t passed_count() const { return passed_count_; }
    std::size_t pair_count() const { return passed_.size(); }

    std::vector<Detail> details(const Assessment& assessment) const override;

private:
    VotingDetector(const DetectorSettings& settings, const geometry::SensorCluster& cluster, geometry::AxisVector sigma);

    void form(AxisMask working) override;
    void judge(const geometry::AxisVector& z, Assessment& assessment) override;
    void set_radii();

    double tolerance_;  ///< configured, or 0
    double pfa_;
    unsigned max_faults_;
    geometry::AxisVector sigma_;

    std::vector<geometry::Triad> triads_;
    std::vector<double> radius_;  ///< each triad's; half the tolerance where that is configured
    std::vector<Eigen::Vector3d> estimate_;
    std::vector<AxisMask> reads_;  ///< for each pair of triads, (0,1), (0,2), …
    std::vector<std::uint8_t> passed_;
    std::size_t passed_count_ = 0;
    double largest_radius_ = 0;
    geometry::AxisMatrix projector_;
};

}  // namespace quorient::fdi
