#pragma once

#include "quorient/geometry/sensor_cluster.hpp"

#include <Eigen/Core>

namespace quorient::geometry {

/// The parity space of a sensor cluster: what its measurements say about their own errors, and nothing about the motion.
///
/// For measurements z = H x + e + f of n single-axis sensors (H: n x 3 unit axes in the body frame, e noise, f faults),
/// V (q x n) is an orthonormal basis of the left null space of H:  V H = 0,  V V' = I.
/// The parity vector p = V z then depends on e and f alone. [Potter & Suman 1977; paper 004, eqs 5-8]
///
/// Only the axes in use count: with m of them, q = m - rank of their rows (m - 3 where they span space; 0 is legal and gives
/// empty parity vectors). Columns of V and rows and columns of P that belong to unused axes are zero, indices stay those of H,
/// and the measurements of unused axes are never read (they may be NaN).
///
/// Nothing here allocates; a space is cheap enough to be rebuilt when an axis is excluded.
///
/// Not guaranteed: V is one of many bases. Compare parity *norms* and *projections* between implementations, never entries
/// (parity_matrix in figures.hpp is the one basis of eq. 8).
class ParitySpace {
public:
    /// @param axes  H, n x 3, as SensorCluster guarantees them.
    /// @param used  axes to work with; bits beyond n are ignored.
    explicit ParitySpace(const Axes& axes, AxisMask used = ~AxisMask{0});

    /// p = V z (q), in the unit of z.
    AxisVector vector(const AxisVector& measurement) const;

    /// r = P z = V'V z (n), the residual of least squares over the axes in use, in the unit of z; 0 for unused axes.
    AxisVector residual(const AxisVector& measurement) const;

    /// Squared parity explained by a fault on one axis:  (v_i' p)^2 / (v_i' v_i) = r_i^2 / P_ii; 0 where the axis is unseen.
    /// The axis with the largest value is the likeliest culprit. [paper 004; Daly, Gai & Harrison 1979, eq 14]
    double explained_by(Eigen::Index axis, const AxisVector& parity) const;

    /// The size of a fault on one axis that fits best:  v_i' p / (v_i' v_i) = r_i / P_ii, in the unit of z; 0 where unseen.
    double fault_estimate(Eigen::Index axis, const AxisVector& parity) const;

    /// A fault on this axis alone leaves a trace (P_ii > 0): the others can predict it. False for unused axes.
    bool sees(Eigen::Index axis) const { return projector_(axis, axis) > unseen; }

    const AxisMatrix& basis() const { return basis_; }          ///< V, q x n
    const AxisMatrix& projector() const { return projector_; }  ///< P = V'V = I - H (H'H)^-1 H' on the axes in use, n x n
    Eigen::Index redundancy() const { return basis_.rows(); }   ///< q
    Eigen::Index size() const { return basis_.cols(); }         ///< n, unused axes included
    AxisMask used() const { return used_; }

private:
    /// Below this P_ii is rounding: the entries of P are sums of at most 24 products of order one.
    static constexpr double unseen = 1e-12;

    AxisMatrix basis_;
    AxisMatrix projector_;
    AxisMask used_;
};

}  // namespace quorient::geometry
