#pragma once

#include <Eigen/Core>

namespace quorient::geometry {

/// x' = A x + B u over one interval in which u is held:  x(t + h) = state x(t) + input u(t).
struct ZeroOrderHold {
    Eigen::MatrixXd state;  ///< exp(A h), n x n
    Eigen::MatrixXd input;  ///< integral of exp(A s) ds B over 0..h, n x m
};

/// Exact to rounding, by the exponential of [[A, B], [0, 0]] h [Van Loan 1978].
/// @param state_matrix A, n x n; @param input_matrix B, n x m; @param interval_s h.
ZeroOrderHold zero_order_hold(const Eigen::MatrixXd& state_matrix, const Eigen::MatrixXd& input_matrix, double interval_s);

}  // namespace quorient::geometry
