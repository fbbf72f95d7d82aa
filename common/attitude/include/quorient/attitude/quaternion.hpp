#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <array>
#include <cmath>

namespace quorient::attitude {

/// q_RB: body -> reference, Hamilton product, dq/dt = 1/2 q o omega_B. On the wire and in arrays (w,x,y,z).
using Quaternion = Eigen::Quaterniond;

inline Quaternion from_array(const std::array<double, 4>& wxyz)
{
    return {wxyz[0], wxyz[1], wxyz[2], wxyz[3]};
}

inline std::array<double, 4> to_array(const Quaternion& q)
{
    return {q.w(), q.x(), q.y(), q.z()};
}

/// The quaternion of the rotation vector phi [rad]: [cos(|phi|/2), sin(|phi|/2) phi/|phi|]. |phi| below 1e150.
inline Quaternion from_rotation_vector(const Eigen::Vector3d& phi)
{
    const double squared = phi.squaredNorm();
    if (squared < 1e-6) {  // the series' next terms are below 1e-22
        const double scale = 0.5 - squared * (1.0 / 48 - squared / 3840);
        return {1 - squared * (0.125 - squared / 384), scale * phi.x(), scale * phi.y(), scale * phi.z()};
    }
    const double angle = std::sqrt(squared);
    const double scale = std::sin(angle / 2) / angle;
    return {std::cos(angle / 2), scale * phi.x(), scale * phi.y(), scale * phi.z()};
}

/// One Newton step towards |q| = 1: exact to rounding where |q| is within 1e-8 of 1, as after every product here.
inline Quaternion renormalised(const Quaternion& q)
{
    Quaternion result;
    result.coeffs() = q.coeffs() * (1.5 - 0.5 * q.squaredNorm());
    return result;
}

/// Geodesic angle between two attitudes [rad], 0 .. pi, accurate also near 0.
inline double angle_between(const Quaternion& a, const Quaternion& b)
{
    const Quaternion difference = a * b.conjugate();
    return 2 * std::atan2(difference.vec().norm(), std::abs(difference.w()));
}

}  // namespace quorient::attitude
