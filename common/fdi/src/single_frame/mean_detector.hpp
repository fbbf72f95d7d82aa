#pragma once

#include "single_frame/frame_detector.hpp"
#include "quorient/fdi/settings.hpp"
#include "single_frame/weighted_parity.hpp"

#include <array>
#include <memory>
#include <string>
#include <tl/expected.hpp>

namespace quorient::fdi {

/// Comparison with the mean, iterated. [paper 002]
///
/// S = |z - H x_hat|^2; while sqrt(S) > T, the axis with the largest |r_i| / sqrt(P_ii) leaves the mean, at most K times and only while
/// two redundant axes are left (with one, all ratios are equal and name nobody). Still failing then: `refused`. One removal is the
/// update r -= P_i r_i / P_ii, P -= P_i P_i' / P_ii.
///
/// Without a tolerance the axes are weighted by their sigma, and T after k removals is the chi-square limit of q - k degrees.
/// For 5 to 24 axes. The paper's rule is greedy: two faults together can push a healthy axis forward. So each set of equal or smaller size is
/// tried as well, and where a second one passes, the frame is `ambiguous` with all of them. Setting `bare` leaves this out.
class MeanDetector final : public FrameDetector {
public:
    /// Settings: tolerance on sqrt(S) (else sigma and pfa), max_faults (default 2), bare.
    static tl::expected<std::unique_ptr<MeanDetector>, std::string> make(const DetectorSettings& settings, const geometry::SensorCluster& cluster);

private:
    MeanDetector(const DetectorSettings& settings, const geometry::SensorCluster& cluster, geometry::AxisVector sigma);

    void form(AxisMask working) override;
    void judge(const geometry::AxisVector& z, Assessment& assessment) override;
    AxisMask leave_out(geometry::AxisVector residual) const;
    void list_rivals(AxisMask named, const geometry::AxisVector& residual, Assessment& assessment) const;

    double configured_tolerance_;  ///< or 0
    double pfa_;
    unsigned max_faults_;
    bool bare_;
    geometry::AxisVector sigma_;
    WeightedParity parity_;
    std::array<double, max_axes> tolerance_{};  ///< on sqrt(S) with that many degrees of freedom
};

}  // namespace quorient::fdi
