#include "quorient/geometry/parity_space.hpp"

#include "quorient/geometry/redundancy.hpp"

#include <Eigen/QR>

namespace quorient::geometry {

ParitySpace::ParitySpace(const Axes& axes, AxisMask used) : used_(used & all_axes(static_cast<std::size_t>(axes.rows())))
{
    const Eigen::Index n = axes.rows();
    Axes kept(n, 3);
    Eigen::Matrix<Eigen::Index, Eigen::Dynamic, 1, Eigen::ColMajor, static_cast<int>(max_axes), 1> place(n);
    Eigen::Index m = 0;
    for (Eigen::Index axis = 0; axis < n; ++axis)
        if (has_axis(used_, static_cast<std::size_t>(axis))) {
            kept.row(m) = axes.row(axis);
            place(m++) = axis;
        }

    basis_ = AxisMatrix::Zero(0, n);
    if (m > 0) {
        Eigen::ColPivHouseholderQR<Axes> factors(m, 3);
        factors.setThreshold(coplanar_tolerance);
        factors.compute(kept.topRows(m));
        const Eigen::Index q = m - factors.rank();
        const AxisMatrix rotation = AxisMatrix(factors.householderQ());
        basis_ = AxisMatrix::Zero(q, n);
        for (Eigen::Index k = 0; k < m; ++k)  // the last q columns of Q are orthogonal to the range of H
            basis_.col(place(k)) = rotation.row(k).tail(q).transpose();
    }
    projector_ = basis_.transpose() * basis_;
}

AxisVector ParitySpace::vector(const AxisVector& measurement) const
{
    if (used_ == all_axes(static_cast<std::size_t>(size()))) return basis_ * measurement;
    AxisVector parity = AxisVector::Zero(redundancy());  // column by column: 0 times the NaN of an unused axis would not be 0
    for (Eigen::Index axis = 0; axis < size(); ++axis)
        if (has_axis(used_, static_cast<std::size_t>(axis))) parity += basis_.col(axis) * measurement(axis);
    return parity;
}

AxisVector ParitySpace::residual(const AxisVector& measurement) const
{
    return basis_.transpose() * vector(measurement);
}

double ParitySpace::explained_by(Eigen::Index axis, const AxisVector& parity) const
{
    if (!sees(axis)) return 0;
    const double projection = basis_.col(axis).dot(parity);
    return projection * projection / projector_(axis, axis);
}

double ParitySpace::fault_estimate(Eigen::Index axis, const AxisVector& parity) const
{
    return sees(axis) ? basis_.col(axis).dot(parity) / projector_(axis, axis) : 0;
}

}  // namespace quorient::geometry
