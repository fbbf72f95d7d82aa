#pragma once

#include "single_frame/frame_detector.hpp"
#include "quorient/fdi/settings.hpp"
#include "single_frame/single_fault.hpp"
#include "single_frame/weighted_parity.hpp"

#include <memory>
#include <string>
#include <tl/expected.hpp>

namespace quorient::fdi {

/// The minimal set of parity equations: p = V m with V of eq. (8), S0 = p'p, D_i = (V_i'p)^2 / (V_i'V_i). [paper 004, algorithm A]
///
/// The same decision as GltDetector (SingleFaultRule), reached through q numbers in place of n. For 4 to 24 axes.
class ParitySetDetector final : public FrameDetector {
public:
    /// Settings: sigma (else from noise), pfa, margin (default 0).
    static tl::expected<std::unique_ptr<ParitySetDetector>, std::string> make(const DetectorSettings& settings,
                                                                      const geometry::SensorCluster& cluster);

    /// p of the last frame, in the unit of z.
    const geometry::AxisVector& parity() const { return p_; }

    std::vector<Detail> details(const Assessment& assessment) const override;

private:
    ParitySetDetector(const geometry::SensorCluster& cluster, geometry::AxisVector sigma, SingleFaultRule rule);

    void form(AxisMask working) override;
    void judge(const geometry::AxisVector& z, Assessment& assessment) override;

    geometry::AxisVector sigma_;
    SingleFaultRule rule_;
    WeightedParity parity_;
    geometry::AxisMatrix matrix_;  ///< V, q x n
    geometry::AxisVector p_;
};

}  // namespace quorient::fdi
