#include "quorient/attitude/body_increment.hpp"

#include <Eigen/Dense>
#include <limits>

namespace quorient::attitude {

BodyIncrement::BodyIncrement(const geometry::SensorCluster& cluster) : size_(cluster.size())
{
    axis_.fill(Eigen::Vector3d::Zero());
    bool known = true;
    for (std::size_t i = 0; i < size_; ++i) {
        const auto row = static_cast<Eigen::Index>(i);
        axis_[i] = cluster.axes.row(row);
        const double sigma = cluster.sigma.size() > row ? cluster.sigma(row) : 0;
        const double quantum = cluster.quantum.size() > row ? cluster.quantum(row) : 0;
        known = known && sigma > 0;
        variance_[i] = sigma * sigma;
        quantum_variance_[i] = quantum * quantum / 6;  // a remainder, uniform within one quantum, at the start and at the end
    }
    for (std::size_t i = 0; i < size_; ++i) weight_[i] = known ? variance_[0] / variance_[i] : 1;
    for (auto& solution : kept_) compute(0, solution);
}

const BodyIncrement::Solution& BodyIncrement::solve(AxisMask axes) const
{
    for (const auto& solution : kept_)
        if (solution.axes == axes) return solution;
    Solution& oldest = kept_[next_];
    next_ = (next_ + 1) % kept_.size();
    compute(axes, oldest);
    return oldest;
}

void BodyIncrement::compute(AxisMask axes, Solution& solution) const
{
    constexpr double largest_condition = 1e6;
    Eigen::Matrix3d plain = Eigen::Matrix3d::Zero();
    Eigen::Matrix3d weighted = Eigen::Matrix3d::Zero();
    for (std::size_t i = 0; i < size_; ++i) {
        if (!has_axis(axes, i)) continue;
        plain += axis_[i] * axis_[i].transpose();
        weighted += weight_[i] * axis_[i] * axis_[i].transpose();
    }
    const Eigen::Vector3d eigenvalue = Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>(plain, Eigen::EigenvaluesOnly).eigenvalues();

    solution = Solution{.axes = axes};
    solution.condition =
        eigenvalue(0) > eigenvalue(2) / largest_condition ? eigenvalue(2) / eigenvalue(0) : std::numeric_limits<double>::infinity();
    solution.independent = solution.condition <= largest_condition;
    if (!solution.independent) return;

    const Eigen::Matrix3d inverse = weighted.inverse();
    for (std::size_t i = 0; i < size_; ++i) {
        if (!has_axis(axes, i)) continue;
        const Eigen::Vector3d column = inverse * (weight_[i] * axis_[i]);
        solution.gain.col(static_cast<Eigen::Index>(i)) = column;
        solution.variance += column.squaredNorm() * variance_[i];
        solution.quantum_variance += column.squaredNorm() * quantum_variance_[i];
    }
}

}  // namespace quorient::attitude
