#pragma once

#include <Eigen/Core>
#include <functional>

namespace quorient::design {

/// Values at x, and (where a matrix is given) their derivatives: a row each.
using Values = std::function<void(const Eigen::VectorXd& x, Eigen::VectorXd& values, Eigen::MatrixXd* derivative)>;

/// The smallest largest value of `minimised`, with `zero` at 0 and `not_above_zero` at most 0. Absent ones do not constrain.
struct MinimaxProblem {
    Values minimised;
    Values zero{};
    Values not_above_zero{};
};

/// A local minimum near `start`, by sequential quadratic programming (NLopt's SLSQP), repeated from where it stopped while that helps.
/// Constraints hold to 1e-12 where they can be met; the caller judges what it gets.
Eigen::VectorXd minimise(const MinimaxProblem& problem, const Eigen::VectorXd& start);

/// A local minimum of a function without derivatives, by linear approximations (NLopt's COBYLA), steps from `first_step` down.
Eigen::VectorXd minimise_without_derivatives(const std::function<double(const Eigen::VectorXd&)>& cost, const Values& not_above_zero,
                                             const Eigen::VectorXd& start, double first_step);

}  // namespace quorient::design
