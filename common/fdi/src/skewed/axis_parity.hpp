#pragma once

#include "field/parameters.hpp"
#include "quorient/geometry/sensor_cluster.hpp"

namespace quorient::fdi::skewed {

using AxisSet = field::InstrumentSet;  ///< bit i stands for axis i, as in AxisMask
using PerAxis = std::array<double, max_axes>;

/// The class' limits are those of one of three instruments, whose parity has this part of a fault's square.
inline constexpr double of_three = 2.0 / 3;

/// Whether these axes measure all three directions.
bool spans_space(const geometry::Axes& axes, AxisSet set);

/// The parity space of some axes of a cluster, in terms of axes: P = I - H (H'H)^-1 H' takes from measurements what any rotation explains. With
/// an orthonormal parity matrix V of these axes P = V'V, so a fault f of axis j alone has the parity f V_j, |V_j|^2 = P_jj, and of a residual r = P z
/// the part along V_j is r_j / sqrt(P_jj). What is left, |r|^2 - r_j^2 / P_jj, is the parity of the others without axis j. [Potter & Suman 1977]
class AxisParity {
public:
    AxisParity() = default;
    AxisParity(const geometry::Axes& axes, AxisSet set);

    AxisSet set() const { return set_; }

    /// Dimensions of the parity space; 0 where the axes do not span space.
    std::size_t redundancy() const { return redundancy_; }

    /// Whether a fault of this axis shows in the parity at all.
    bool sees(std::size_t axis) const { return redundancy_ > 0 && share(axis, axis) > unseen; }

    /// P_ij, of axes of the set.
    double share(std::size_t i, std::size_t j) const { return projector_(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(j)); }

    /// P z; 0 outside the set. @param z  one value per axis; what is outside the set counts for nothing.
    PerAxis residual(const PerAxis& z) const;

    /// The body vector of these measurements by least squares.
    Eigen::Vector3d body(const PerAxis& z) const;

    /// The same without one axis, of measurements whose residual is r: z_j is replaced by what the others expect.
    Eigen::Vector3d body_without(std::size_t axis, const PerAxis& z, const PerAxis& residual) const;

    /// Standard deviation of the body vector along this direction, in units of one axis'.
    double spread(const Eigen::Vector3d& direction) const;

    /// The part of a residual along the parity of axis j, and the root mean square of what is left per degree of freedom.
    struct Split {
        double along = 0;
        double others = 0;
    };
    Split split(std::size_t axis, const PerAxis& residual) const;

private:
    static constexpr double unseen = 1e-3;

    AxisSet set_;
    std::size_t redundancy_ = 0;
    geometry::Axes axes_;  ///< rows outside the set are 0
    Eigen::Matrix<double, 3, Eigen::Dynamic, Eigen::ColMajor, 3, static_cast<int>(max_axes)> estimator_;
    geometry::AxisMatrix projector_;
};

}  // namespace quorient::fdi::skewed
