#pragma once

#include "quorient/geometry/parity_space.hpp"
#include "quorient/geometry/sensor_cluster.hpp"

#include <Eigen/Core>
#include <optional>
#include <span>

/// How good a layout is: accuracy of the body vector, and how well faults show. Entries that are undefined are NaN.
namespace quorient::geometry {

/// The rows of the axes in use, in their order.
Axes select(const Axes& axes, AxisMask used);

/// Covariance of the least-squares body vector for unit noise: (H'H)^-1. [paper 002]
struct Accuracy {
    Eigen::Vector3d eigenvalues;  ///< largest first
    double trace = 0;
    double volume = 0;     ///< sqrt(det): of the ellipsoid of scatter, without the factor 4 pi / 3
    double condition = 0;  ///< largest over smallest eigenvalue
};

/// Nothing where the axes in use do not span space.
std::optional<Accuracy> accuracy(const Axes& axes, AxisMask used = ~AxisMask{0});

/// The smallest angle between two axes, taken as lines (0..pi/2) [rad]. Nothing for fewer than two axes.
std::optional<double> minimum_angle_rad(const Axes& axes, AxisMask used = ~AxisMask{0});

/// The minimal set of parity equations: V (q x n) in the triangular form of eq. (8), with V_ii^2 = W_ii - sum_k<i V_ki^2 (the paper
/// prints W_11), zero pivots skipped, W = P. Columns of unused axes are zero. [Potter & Suman; paper 004, eq 8]
AxisMatrix parity_matrix(const ParitySpace& space);

/// One parity equation per axis: row i is 1 at i and minus the least-squares prediction of axis i by the others elsewhere, so
/// v_ij = W_ij / W_ii and the variance is sigma^2 / W_ii. Rows of axes that the others cannot predict are NaN. [eq 33]
AxisMatrix parity_equations(const ParitySpace& space);

/// The same without the other axes of the axis's own instrument, whose coefficients are 0. Tables 1-3 of paper 004 follow this rule
/// without stating it: there a two-axis gyro fails as a whole.
AxisMatrix parity_equations_without_partners(const Axes& axes, std::span<const std::size_t> instrument);

/// J_j = V_j' (V V')^-1 V_j = W_jj of the minimal set; NaN for unused axes and where nothing is redundant. [eq 20]
AxisVector detection_index(const ParitySpace& space);

/// J_ij = v_ij^2 / sum_k v_ik^2 of a set of parity equations. [eq 39]
AxisMatrix isolation_index(const AxisMatrix& equations);

/// F_d1 = min_j J_j over the axes in use; at most q / n. [eq 22]
double f_d1(const ParitySpace& space);

/// F_d2 = min_i J_ii / max_{j != i} J_ij, literally; NaN where an axis in use has no parity equation. [eq 42]
double f_d2(const ParitySpace& space);

/// F_d2 by parity_equations_without_partners; nothing where every axis is its own instrument. [paper 004, Tables 1-3]
std::optional<double> f_d2_partner_excluded(const Axes& axes, std::span<const std::size_t> instrument);

}  // namespace quorient::geometry
