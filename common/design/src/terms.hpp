#pragma once

#include "quorient/geometry/sensor_cluster.hpp"

#include <Eigen/Core>
#include <span>
#include <utility>
#include <vector>

namespace quorient::design {

/// Values to be kept small, and how they change with the axes: a row each, 3 n columns (all x, all y, all z of the rows of H).
struct Terms {
    Terms(Eigen::Index count, Eigen::Index axes) : value(count), gradient(Eigen::MatrixXd::Zero(count, 3 * axes)) {}

    Eigen::VectorXd value;
    Eigen::MatrixXd gradient;
};

using AxisPair = std::pair<Eigen::Index, Eigen::Index>;

/// tr(A^-1) without each of these sets of axes, A = H'H of the rows left. Where A is singular: huge, without a direction.
Terms trace_terms(const geometry::Axes& rows, std::span<const AxisMask> removed);

/// log sqrt(det A^-1) likewise.
Terms volume_terms(const geometry::Axes& rows, std::span<const AxisMask> removed);

/// (h_i'h_j)^2 of these pairs of unit axes.
Terms cosine_terms(const geometry::Axes& axes, std::span<const AxisPair> pairs);

/// -W_ii of each axis, W = I - H A^-1 H': the largest is -F_d1.
Terms visibility_terms(const geometry::Axes& rows);

/// W_ij^2 / W_ii^2 of every two axes: the largest is 1 / F_d2.
Terms rivalry_terms(const geometry::Axes& rows);

/// xy, xz, yz, xx - zz, yy - zz of A: all zero where A is a multiple of the identity.
Terms anisotropy_terms(const geometry::Axes& rows);

}  // namespace quorient::design
