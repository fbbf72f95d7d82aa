#pragma once

#include <Eigen/Core>

namespace quorient::rotation {

/// The orthogonal matrix R of smallest |m - R|: U V' of the singular value decomposition m = U S V'. A reflection where det(m) < 0.
Eigen::Matrix3d nearest_orthogonal(const Eigen::Matrix3d& m);

/// The rotation R of smallest |m - R|, which solves Wahba's problem for the profile m = sum b_i a_i' of directions a_i turned into b_i.
/// Never a reflection: where U V' is one, it turns over the direction of the smallest singular value.
Eigen::Matrix3d nearest_rotation(const Eigen::Matrix3d& m);

/// The singular values of m, largest first. The second is near 0 where the directions of a profile are all along one line: then no
/// rotation is determined.
Eigen::Vector3d singular_values(const Eigen::Matrix3d& m);

}  // namespace quorient::rotation
