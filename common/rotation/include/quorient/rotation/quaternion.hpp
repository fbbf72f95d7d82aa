#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <array>
#include <cmath>

namespace quorient::rotation {

/// q_RB: body -> reference, Hamilton product, dq/dt = 1/2 q o omega_B.
using Quaternion = Eigen::Quaterniond;

/// The same as it travels and is stored: (w,x,y,z).
using Wxyz = std::array<double, 4>;

inline constexpr Wxyz no_rotation{1, 0, 0, 0};

inline Quaternion from_array(const Wxyz& wxyz)
{
    return {wxyz[0], wxyz[1], wxyz[2], wxyz[3]};
}

inline Wxyz to_array(const Quaternion& q)
{
    return {q.w(), q.x(), q.y(), q.z()};
}

/// left o right
inline Wxyz product(const Wxyz& left, const Wxyz& right)
{
    return to_array(from_array(left) * from_array(right));
}

inline Wxyz conjugate(const Wxyz& q)
{
    return {q[0], -q[1], -q[2], -q[3]};
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

/// The shortest rotation vector of a unit quaternion [rad], norm 0 to pi.
inline Eigen::Vector3d to_rotation_vector(const Quaternion& q)
{
    const double sine = q.vec().norm();
    const double sign = q.w() < 0 ? -1 : 1;
    if (sine < 1e-12) return 2 * sign * q.vec();
    return sign * 2 * std::atan2(sine, std::abs(q.w())) / sine * q.vec();
}

/// One Newton step towards |q| = 1: exact to rounding where |q| is within 1e-8 of 1, as after every product here.
inline Quaternion renormalised(const Quaternion& q)
{
    Quaternion result;
    result.coeffs() = q.coeffs() * (1.5 - 0.5 * q.squaredNorm());
    return result;
}

/// Angle of a rotation [rad], 0 to pi: 2 atan2(|v|, |w|). Accurate near 0, where acos is not.
inline double angle_of(const Quaternion& q)
{
    return 2 * std::atan2(q.vec().norm(), std::abs(q.w()));
}
inline double angle_of(const Wxyz& q)
{
    return angle_of(from_array(q));
}

/// Angle of the shortest rotation from one attitude to the other [rad], 0 to pi.
inline double angle_between(const Quaternion& a, const Quaternion& b)
{
    return angle_of(a * b.conjugate());
}
inline double angle_between(const Wxyz& a, const Wxyz& b)
{
    return angle_between(from_array(a), from_array(b));
}

/// Finite and of unit norm: within 1e-6, far above rounding and far below a wrong attitude.
inline bool is_attitude(const Wxyz& q)
{
    return from_array(q).coeffs().allFinite() && std::abs(from_array(q).norm() - 1) < 1e-6;
}

}  // namespace quorient::rotation
