#include "quorient/geometry/figures.hpp"

#include "quorient/geometry/redundancy.hpp"

#include <Eigen/Eigenvalues>
#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>

namespace quorient::geometry {

namespace {

constexpr double undefined = std::numeric_limits<double>::quiet_NaN();

/// A pivot of eq. (8) below this is rounding: W has entries of order one.
constexpr double zero_pivot = 1e-12;

bool in_use(AxisMask used, Eigen::Index axis)
{
    return has_axis(used, static_cast<std::size_t>(axis));
}

Eigen::RowVectorXd equation_of(const ParitySpace& space, Eigen::Index axis)
{
    if (!space.sees(axis)) return Eigen::RowVectorXd::Constant(space.size(), undefined);
    return space.projector().row(axis) / space.projector()(axis, axis);
}

/// min over the axes in use of J_ii / max_{j != i} J_ij; NaN as soon as one is.
double isolation_merit(const AxisMatrix& index, AxisMask used)
{
    double merit = std::numeric_limits<double>::infinity();
    for (Eigen::Index i = 0; i < index.rows(); ++i) {
        if (!in_use(used, i)) continue;
        if (std::isnan(index(i, i))) return undefined;
        double strongest_other = 0;
        for (Eigen::Index j = 0; j < index.cols(); ++j)
            if (j != i) strongest_other = std::max(strongest_other, index(i, j));
        merit = std::min(merit, index(i, i) / strongest_other);
    }
    return merit;
}

}  // namespace

Axes select(const Axes& axes, AxisMask used)
{
    Axes selected(axes.rows(), 3);
    Eigen::Index count = 0;
    for (Eigen::Index axis = 0; axis < axes.rows(); ++axis)
        if (in_use(used, axis)) selected.row(count++) = axes.row(axis);
    return selected.topRows(count);
}

std::optional<Accuracy> accuracy(const Axes& axes, AxisMask used)
{
    if (rank_of(axes, used) < 3) return std::nullopt;
    const Axes kept = select(axes, used);
    const Eigen::Matrix3d information = kept.transpose() * kept;
    const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver(information, Eigen::EigenvaluesOnly);
    const Eigen::Vector3d eigenvalues = solver.eigenvalues().cwiseInverse();  // ascending information: largest variance first
    return Accuracy{eigenvalues, eigenvalues.sum(), std::sqrt(eigenvalues.prod()), eigenvalues(0) / eigenvalues(2)};
}

std::optional<double> minimum_angle_rad(const Axes& axes, AxisMask used)
{
    const Axes kept = select(axes, used);
    if (kept.rows() < 2) return std::nullopt;
    double smallest = std::numeric_limits<double>::infinity();
    for (Eigen::Index i = 0; i < kept.rows(); ++i)
        for (Eigen::Index j = i + 1; j < kept.rows(); ++j) {
            const Eigen::Vector3d a = kept.row(i), b = kept.row(j);
            smallest = std::min(smallest, std::atan2(a.cross(b).norm(), std::abs(a.dot(b))));
        }
    return smallest;
}

AxisMatrix parity_matrix(const ParitySpace& space)
{
    const AxisMatrix& w = space.projector();
    const Eigen::Index n = space.size();
    AxisMatrix v = AxisMatrix::Zero(space.redundancy(), n);
    Eigen::Index row = 0;
    for (Eigen::Index i = 0; i < n && row < v.rows(); ++i) {
        const double square = w(i, i) - v.col(i).head(row).squaredNorm();
        if (square < zero_pivot) continue;
        v(row, i) = std::sqrt(square);
        for (Eigen::Index j = i + 1; j < n; ++j) v(row, j) = (w(i, j) - v.col(i).head(row).dot(v.col(j).head(row))) / v(row, i);
        ++row;
    }
    return v.topRows(row);
}

AxisMatrix parity_equations(const ParitySpace& space)
{
    AxisMatrix equations(space.size(), space.size());
    for (Eigen::Index axis = 0; axis < space.size(); ++axis) equations.row(axis) = equation_of(space, axis);
    return equations;
}

AxisMatrix parity_equations_without_partners(const Axes& axes, std::span<const std::size_t> instrument)
{
    AxisMatrix equations(axes.rows(), axes.rows());
    for (Eigen::Index axis = 0; axis < axes.rows(); ++axis) {
        AxisMask used = axis_bit(static_cast<std::size_t>(axis));
        for (std::size_t other = 0; other < instrument.size(); ++other)
            if (instrument[other] != instrument[static_cast<std::size_t>(axis)]) used |= axis_bit(other);
        equations.row(axis) = equation_of(ParitySpace(axes, used), axis);
    }
    return equations;
}

AxisVector detection_index(const ParitySpace& space)
{
    AxisVector index = AxisVector::Constant(space.size(), undefined);
    if (space.redundancy() == 0) return index;
    for (Eigen::Index axis = 0; axis < space.size(); ++axis)
        if (in_use(space.used(), axis)) index(axis) = space.sees(axis) ? space.projector()(axis, axis) : 0;
    return index;
}

AxisMatrix isolation_index(const AxisMatrix& equations)
{
    AxisMatrix index = equations.cwiseAbs2();
    for (Eigen::Index axis = 0; axis < index.rows(); ++axis) index.row(axis) /= index.row(axis).sum();
    return index;
}

double f_d1(const ParitySpace& space)
{
    const AxisVector index = detection_index(space);
    double merit = std::numeric_limits<double>::infinity();
    for (Eigen::Index axis = 0; axis < space.size(); ++axis)
        if (in_use(space.used(), axis)) merit = std::min(merit, index(axis));
    return std::isfinite(merit) && space.redundancy() > 0 ? merit : undefined;
}

double f_d2(const ParitySpace& space)
{
    if (space.redundancy() == 0) return undefined;
    return isolation_merit(isolation_index(parity_equations(space)), space.used());
}

std::optional<double> f_d2_partner_excluded(const Axes& axes, std::span<const std::size_t> instrument)
{
    const bool partners = std::ranges::any_of(instrument, [&](std::size_t one) { return std::ranges::count(instrument, one) > 1; });
    if (!partners) return std::nullopt;
    return isolation_merit(isolation_index(parity_equations_without_partners(axes, instrument)), all_axes(instrument.size()));
}

}  // namespace quorient::geometry
