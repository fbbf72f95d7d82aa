#include "quorient/geometry/redundancy.hpp"

#include "quorient/geometry/figures.hpp"

#include <Eigen/Eigenvalues>
#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>

namespace quorient::geometry {

namespace {

/// How many instruments have an axis in use outside the plane with this unit normal.
std::size_t instruments_outside(const Axes& axes, std::span<const std::size_t> instrument, AxisMask used, const Eigen::Vector3d& normal)
{
    std::array<bool, max_axes> outside{};
    for (std::size_t axis = 0; axis < instrument.size(); ++axis)
        if (has_axis(used, axis) && std::abs(axes.row(static_cast<Eigen::Index>(axis)).dot(normal)) > coplanar_tolerance)
            outside[instrument[axis]] = true;
    return static_cast<std::size_t>(std::ranges::count(outside, true));
}

/// The size of the smallest set of instruments whose faults can cancel: the fewest outside one plane.
/// A plane that leaves the fewest outside contains two axes that are not parallel, or could be tilted until it does.
std::size_t smallest_hidden_set(const Axes& axes, std::span<const std::size_t> instrument, AxisMask used)
{
    std::size_t smallest = instrument.size();
    for (Eigen::Index i = 0; i < axes.rows(); ++i) {
        if (!has_axis(used, static_cast<std::size_t>(i))) continue;
        for (Eigen::Index j = i + 1; j < axes.rows(); ++j) {
            if (!has_axis(used, static_cast<std::size_t>(j))) continue;
            const Eigen::Vector3d normal = axes.row(i).transpose().cross(axes.row(j).transpose());
            if (normal.norm() <= coplanar_tolerance) continue;
            smallest = std::min(smallest, instruments_outside(axes, instrument, used, normal.normalized()));
        }
    }
    return smallest;
}

std::array<std::size_t, max_axes> own_instruments()
{
    std::array<std::size_t, max_axes> own{};
    for (std::size_t axis = 0; axis < max_axes; ++axis) own[axis] = axis;
    return own;
}

}  // namespace

int rank_of(const Axes& axes, AxisMask used)
{
    const Axes kept = select(axes, used);
    if (kept.rows() == 0) return 0;
    const Eigen::Matrix3d normal_matrix = kept.transpose() * kept;
    const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver(normal_matrix, Eigen::EigenvaluesOnly);
    const Eigen::Vector3d& squares = solver.eigenvalues();  // squared singular values of the rows, ascending
    return static_cast<int>((squares.array() > coplanar_tolerance * coplanar_tolerance * squares(2)).count());
}

unsigned detectable_instruments_with(const Axes& axes, std::span<const std::size_t> instrument, AxisMask used)
{
    if (rank_of(axes, used) < 3) return 0;
    return static_cast<unsigned>(smallest_hidden_set(axes, instrument, used)) - 1;
}

unsigned isolable_instruments_with(const Axes& axes, std::span<const std::size_t> instrument, AxisMask used)
{
    return detectable_instruments_with(axes, instrument, used) / 2;
}

unsigned detectable_with(const Axes& axes, AxisMask used)
{
    const auto own = own_instruments();
    return detectable_instruments_with(axes, std::span(own).first(static_cast<std::size_t>(axes.rows())), used);
}

unsigned isolable_with(const Axes& axes, AxisMask used)
{
    return detectable_with(axes, used) / 2;
}

}  // namespace quorient::geometry
