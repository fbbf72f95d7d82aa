#pragma once

#include "single_frame/frame_detector.hpp"
#include "quorient/fdi/settings.hpp"
#include "single_frame/single_fault.hpp"
#include "single_frame/weighted_parity.hpp"

#include <memory>
#include <string>
#include <tl/expected.hpp>

namespace quorient::fdi {

/// One faulty axis from the least-squares residual r = P z: S0 = |r|^2 and D_i = r_i^2 / P_ii, see SingleFaultRule. [paper 004]
///
/// The n parity equations (each axis minus its prediction by the others) are p_i = r_i / P_ii, which is also the estimate of the fault.
/// Axes of unequal sigma are whitened first, see WeightedParity. For 4 to 24 axes; on four, all axes explain a fault alike: it is seen,
/// and ambiguous.
class GltDetector final : public FrameDetector {
public:
    /// Settings: sigma (else from noise), pfa, margin (default 0).
    static tl::expected<std::unique_ptr<GltDetector>, std::string> make(const DetectorSettings& settings,
                                                                            const geometry::SensorCluster& cluster);

    /// What the last frame gave, in (squared) units of z.
    double explained(std::size_t axis) const { return explained_(static_cast<Eigen::Index>(axis)); }  ///< D_i
    double parity(std::size_t axis) const;                                                            ///< p_i

    std::vector<Detail> details(const Assessment& assessment) const override;

private:
    GltDetector(const geometry::SensorCluster& cluster, geometry::AxisVector sigma, SingleFaultRule rule);

    void form(AxisMask working) override;
    void judge(const geometry::AxisVector& z, Assessment& assessment) override;

    geometry::AxisVector sigma_;
    SingleFaultRule rule_;
    WeightedParity parity_;
    geometry::AxisVector residual_;
    geometry::AxisVector explained_;
};

}  // namespace quorient::fdi
