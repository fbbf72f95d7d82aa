#include "quorient/geometry/triads.hpp"

#include "quorient/geometry/redundancy.hpp"

#include <Eigen/Eigenvalues>
#include <Eigen/LU>
#include <cmath>

namespace quorient::geometry {

namespace {

/// The largest singular value.
double spectral_norm(const Eigen::Matrix3d& matrix)
{
    const Eigen::Matrix3d square = matrix.transpose() * matrix;
    return std::sqrt(Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>(square, Eigen::EigenvaluesOnly).eigenvalues()(2));
}

}  // namespace

std::optional<Triad> triad_inverse(const Axes& axes, std::array<std::size_t, 3> axis)
{
    Eigen::Matrix3d rows;
    for (Eigen::Index k = 0; k < 3; ++k) rows.row(k) = axes.row(static_cast<Eigen::Index>(axis[static_cast<std::size_t>(k)]));
    const Eigen::Matrix3d inverse = rows.inverse();
    if (!inverse.allFinite()) return std::nullopt;
    const double condition = spectral_norm(rows) * spectral_norm(inverse);
    if (condition * coplanar_tolerance > 1) return std::nullopt;
    return Triad{axis, inverse, condition};
}

std::optional<BodyFromAxes> least_squares_inverse(const Axes& axes, AxisMask used)
{
    if (rank_of(axes, used) < 3) return std::nullopt;
    Axes kept = axes;
    for (Eigen::Index axis = 0; axis < axes.rows(); ++axis)
        if (!has_axis(used, static_cast<std::size_t>(axis))) kept.row(axis).setZero();
    const Eigen::Matrix3d information = kept.transpose() * kept;
    return information.inverse() * kept.transpose();
}

std::vector<Triad> triads(const Axes& axes, AxisMask used)
{
    std::vector<Triad> all;
    const auto n = static_cast<std::size_t>(axes.rows());
    for (std::size_t i = 0; i < n; ++i)
        for (std::size_t j = i + 1; j < n; ++j)
            for (std::size_t k = j + 1; k < n; ++k) {
                const AxisMask mask = axis_bit(i) | axis_bit(j) | axis_bit(k);
                if ((mask & used) != mask) continue;
                if (const auto triad = triad_inverse(axes, {i, j, k})) all.push_back(*triad);
            }
    return all;
}

}  // namespace quorient::geometry
