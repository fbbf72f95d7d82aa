#include "skewed/axis_parity.hpp"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>

namespace quorient::fdi::skewed {
namespace {

/// Axes whose information on any direction is less do not span space.
constexpr double no_information = 1e-3;

Eigen::Matrix3d information_of(const geometry::Axes& axes, AxisSet set)
{
    Eigen::Matrix3d information = Eigen::Matrix3d::Zero();
    for (Eigen::Index i = 0; i < axes.rows(); ++i)
        if (set.has(static_cast<std::size_t>(i))) information += axes.row(i).transpose() * axes.row(i);
    return information;
}

bool is_regular(const Eigen::Matrix3d& information)
{
    return Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>(information, Eigen::EigenvaluesOnly).eigenvalues().minCoeff() > no_information;
}

}  // namespace

bool spans_space(const geometry::Axes& axes, AxisSet set)
{
    return is_regular(information_of(axes, set));
}

AxisParity::AxisParity(const geometry::Axes& axes, AxisSet set) : set_(set), axes_(axes)
{
    for (Eigen::Index i = 0; i < axes_.rows(); ++i)
        if (!set.has(static_cast<std::size_t>(i))) axes_.row(i).setZero();
    const Eigen::Matrix3d information = information_of(axes_, set);
    estimator_.setZero(3, axes_.rows());
    projector_.setZero(axes_.rows(), axes_.rows());
    if (set.size() < 4 || !is_regular(information)) return;
    redundancy_ = set.size() - 3;
    estimator_ = information.inverse() * axes_.transpose();
    projector_ = -axes_ * estimator_;
    for (Eigen::Index i = 0; i < axes_.rows(); ++i)
        if (set.has(static_cast<std::size_t>(i))) projector_(i, i) += 1;
}

Eigen::Vector3d AxisParity::body(const PerAxis& z) const
{
    Eigen::Vector3d body = Eigen::Vector3d::Zero();
    for (Eigen::Index i = 0; i < axes_.rows(); ++i)
        if (set_.has(static_cast<std::size_t>(i))) body += estimator_.col(i) * z[static_cast<std::size_t>(i)];
    return body;
}

PerAxis AxisParity::residual(const PerAxis& z) const
{
    PerAxis residual{};
    if (redundancy_ == 0) return residual;
    const Eigen::Vector3d explained = body(z);
    for (Eigen::Index i = 0; i < axes_.rows(); ++i)
        if (set_.has(static_cast<std::size_t>(i)))
            residual[static_cast<std::size_t>(i)] = z[static_cast<std::size_t>(i)] - axes_.row(i).dot(explained);
    return residual;
}

Eigen::Vector3d AxisParity::body_without(std::size_t axis, const PerAxis& z, const PerAxis& residual) const
{
    if (!set_.has(axis)) return body(z);
    return body(z) - estimator_.col(static_cast<Eigen::Index>(axis)) * (residual[axis] / share(axis, axis));
}

double AxisParity::spread(const Eigen::Vector3d& direction) const
{
    double squares = 0;
    for (Eigen::Index i = 0; i < estimator_.cols(); ++i) squares += std::pow(estimator_.col(i).dot(direction), 2);
    return std::sqrt(squares);
}

AxisParity::Split AxisParity::split(std::size_t axis, const PerAxis& residual) const
{
    double squares = 0;
    for (Eigen::Index i = 0; i < axes_.rows(); ++i) squares += residual[static_cast<std::size_t>(i)] * residual[static_cast<std::size_t>(i)];
    const double along = residual[axis] / std::sqrt(share(axis, axis));
    const double left = std::max(0.0, squares - along * along);
    return {along, redundancy_ > 1 ? std::sqrt(left / static_cast<double>(redundancy_ - 1)) : 0};
}

}  // namespace quorient::fdi::skewed
