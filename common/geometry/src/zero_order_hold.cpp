#include "quorient/geometry/zero_order_hold.hpp"

#include <unsupported/Eigen/MatrixFunctions>

namespace quorient::geometry {

ZeroOrderHold zero_order_hold(const Eigen::MatrixXd& state_matrix, const Eigen::MatrixXd& input_matrix, double interval_s)
{
    const Eigen::Index n = state_matrix.rows();
    const Eigen::Index m = input_matrix.cols();
    Eigen::MatrixXd both = Eigen::MatrixXd::Zero(n + m, n + m);
    both.topLeftCorner(n, n) = state_matrix * interval_s;
    both.topRightCorner(n, m) = input_matrix * interval_s;
    const Eigen::MatrixXd exponential = both.exp();
    return {exponential.topLeftCorner(n, n), exponential.topRightCorner(n, m)};
}

}  // namespace quorient::geometry
