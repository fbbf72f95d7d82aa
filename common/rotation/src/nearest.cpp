#include "quorient/rotation/nearest.hpp"

#include <Eigen/LU>
#include <Eigen/SVD>

namespace quorient::rotation {
namespace {

using Decomposition = Eigen::JacobiSVD<Eigen::Matrix3d, Eigen::NoQRPreconditioner>;  // a square matrix needs no QR step first

Decomposition decomposed(const Eigen::Matrix3d& m)
{
    return Decomposition(m, Eigen::ComputeFullU | Eigen::ComputeFullV);
}

}  // namespace

Eigen::Matrix3d nearest_orthogonal(const Eigen::Matrix3d& m)
{
    const auto svd = decomposed(m);
    return svd.matrixU() * svd.matrixV().transpose();
}

Eigen::Matrix3d nearest_rotation(const Eigen::Matrix3d& m)
{
    const auto svd = decomposed(m);
    Eigen::Matrix3d u = svd.matrixU();
    if ((u * svd.matrixV().transpose()).determinant() < 0) u.col(2) *= -1;
    return u * svd.matrixV().transpose();
}

Eigen::Vector3d singular_values(const Eigen::Matrix3d& m)
{
    return decomposed(m).singularValues();
}

}  // namespace quorient::rotation
