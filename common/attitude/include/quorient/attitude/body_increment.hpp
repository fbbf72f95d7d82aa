#pragma once

#include "quorient/geometry/sensor_cluster.hpp"
#include "quorient/messages/limits.hpp"

#include <Eigen/Core>
#include <array>

namespace quorient::attitude {

/// Body increments from the trusted axes of a cluster by weighted least squares:
///   theta = G z,  G = (H' W H)^-1 H' W,  W = diag(1 / sigma_i^2)  (equal weights where a sigma is unknown)
/// With three axes this is the inverse of the triad (paper 003, eqs 14-17). Solutions of the latest masks are kept: asking for
/// a mask again costs a comparison. Not thread-safe.
class BodyIncrement {
public:
    explicit BodyIncrement(const geometry::SensorCluster& cluster);

    using Gain = Eigen::Matrix<double, 3, static_cast<int>(max_axes)>;

    struct Solution {
        AxisMask axes = 0;
        bool independent = false;     ///< three axes that span space (eigenvalue ratio up to 1e6); else gain is 0
        double condition = 0;         ///< largest / smallest eigenvalue of H'H over these axes; infinite where rank < 3
        Gain gain = Gain::Zero();     ///< G, 0 in the columns of other axes
        double variance = 0;          ///< trace of the noise covariance of theta at the nominal interval [rad^2]
        double quantum_variance = 0;  ///< the same of a carried quantiser's remainder, which does not grow [rad^2]
    };

    const Solution& solve(AxisMask axes) const;

    /// Whether these axes may stand in for all: three or more, condition up to 10 (orthogonal-3-plus-1 without an axis: 9.9).
    bool well_conditioned(AxisMask axes) const { return solve(axes).condition <= 10; }

private:
    void compute(AxisMask axes, Solution& solution) const;

    std::size_t size_;
    std::array<Eigen::Vector3d, max_axes> axis_;
    std::array<double, max_axes> weight_{};
    std::array<double, max_axes> variance_{};
    std::array<double, max_axes> quantum_variance_{};
    mutable std::array<Solution, 8> kept_;
    mutable std::size_t next_ = 0;
};

}  // namespace quorient::attitude
