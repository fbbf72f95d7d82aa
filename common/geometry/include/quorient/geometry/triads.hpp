#pragma once

#include "quorient/geometry/sensor_cluster.hpp"

#include <Eigen/Core>
#include <array>
#include <optional>
#include <vector>

namespace quorient::geometry {

/// Three axes of a cluster that span space, and the body vector they give: theta = body_from_axes (z_i, z_j, z_k)'.
/// [paper 003, eqs 14-17, 23-26, 31-34, corrected]
struct Triad {
    std::array<std::size_t, 3> axis{};  ///< ascending
    Eigen::Matrix3d body_from_axes;     ///< inverse of the three rows of H, in the order of `axis`
    double condition = 0;               ///< largest over smallest singular value of the three rows, >= 1

    AxisMask mask() const { return axis_bit(axis[0]) | axis_bit(axis[1]) | axis_bit(axis[2]); }

    /// The body vector [unit of z] from all the axes' measurements.
    template <class Measurement>
    Eigen::Vector3d body(const Measurement& z) const
    {
        using Index = Eigen::Index;
        const Eigen::Vector3d three(z[static_cast<Index>(axis[0])], z[static_cast<Index>(axis[1])], z[static_cast<Index>(axis[2])]);
        return body_from_axes * three;
    }
};

/// The triad of three different axes; nothing where they lie in one plane (within coplanar_tolerance). Allocates nothing.
std::optional<Triad> triad_inverse(const Axes& axes, std::array<std::size_t, 3> axis);

/// All triads of the axes in use in lexicographic order, those in one plane left out.
/// For four axes these are T1..T4 of paper 003: (0,1,2), (0,1,3), (0,2,3), (1,2,3).
std::vector<Triad> triads(const Axes& axes, AxisMask used = ~AxisMask{0});

/// 3 x n, body vector from all axes.
using BodyFromAxes = Eigen::Matrix<double, 3, Eigen::Dynamic, Eigen::ColMajor, 3, static_cast<int>(max_axes)>;

/// B = (H'H)^-1 H' of the axes in use, columns of the others zero: the least-squares body vector is B z. Nothing where the axes
/// in use do not span space. Allocates nothing. [paper 003, eqs 7, 12, 21 (row 1 corrected), 30]
std::optional<BodyFromAxes> least_squares_inverse(const Axes& axes, AxisMask used = ~AxisMask{0});

}  // namespace quorient::geometry
