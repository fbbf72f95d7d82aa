#pragma once

#include "quorient/attitude/propagator.hpp"

#include <cmath>
#include <cstdint>
#include <numbers>

namespace quorient::attitude::testing {

using Wide = long double;

/// Classic coning in closed form: the body's z axis half angle away from a fixed axis, and around it at a frequency.
///   q(t) = [cos(a/2), sin(a/2) cos(Wt), sin(a/2) sin(Wt), 0]
///   omega_B = [-W sin a sin(Wt), W sin a cos(Wt), -W (1 - cos a)]
class ClassicConing {
public:
    ClassicConing(double half_angle_deg, double frequency_hz)
        : half_angle_(half_angle_deg * std::numbers::pi_v<Wide> / 180), angular_rate_(2 * std::numbers::pi_v<Wide> * frequency_hz)
    {
    }

    Quaternion attitude(Wide time_s) const
    {
        const Wide tilt = std::sin(half_angle_ / 2);
        const Wide phase = angular_rate_ * time_s;
        return {static_cast<double>(std::cos(half_angle_ / 2)), static_cast<double>(tilt * std::cos(phase)),
                static_cast<double>(tilt * std::sin(phase)), 0};
    }

    /// The integral of the body rate over [begin, begin + interval].
    Eigen::Vector3d increment(Wide begin_s, Wide interval_s) const
    {
        const Wide middle = angular_rate_ * (begin_s + interval_s / 2);
        const Wide chord = 2 * std::sin(angular_rate_ * interval_s / 2) * std::sin(half_angle_);
        const Wide versine = 2 * std::sin(half_angle_ / 2) * std::sin(half_angle_ / 2);
        return {static_cast<double>(-chord * std::sin(middle)), static_cast<double>(chord * std::cos(middle)),
                static_cast<double>(-versine * angular_rate_ * interval_s)};
    }

private:
    Wide half_angle_;
    Wide angular_rate_;
};

/// Paper 003's motion (eqs 46-48, the factor of 48 corrected): omega_B = (k3, k2 cos k3 t, -k2 sin k3 t).
class PaperMotion {
public:
    PaperMotion(double k2, double k3) : k2_(k2), k3_(k3) {}

    /// q(t) for q(0) = 1: a turn about a fixed y by k2 t, then one about the body's x by k3 t.
    Quaternion attitude(Wide time_s) const
    {
        const Wide cy = std::cos(k2_ * time_s / 2);
        const Wide sy = std::sin(k2_ * time_s / 2);
        const Wide cx = std::cos(k3_ * time_s / 2);
        const Wide sx = std::sin(k3_ * time_s / 2);
        return {static_cast<double>(cy * cx), static_cast<double>(cy * sx), static_cast<double>(sy * cx), static_cast<double>(-sy * sx)};
    }

    Eigen::Vector3d increment(Wide begin_s, Wide interval_s) const
    {
        const Wide middle = k3_ * (begin_s + interval_s / 2);
        const Wide chord = 2 * k2_ / k3_ * std::sin(k3_ * interval_s / 2);
        return {static_cast<double>(k3_ * interval_s), static_cast<double>(chord * std::cos(middle)),
                static_cast<double>(-chord * std::sin(middle))};
    }

private:
    Wide k2_;
    Wide k3_;
};

/// Angle error at the end of `duration_s`, from the first row on [rad].
template <class Motion>
double error_after(std::string_view algorithm, const Motion& motion, double interval_s, double duration_s)
{
    Propagator propagator(make_update(algorithm).value(), motion.attitude(0));
    const auto rows = static_cast<std::uint64_t>(std::llround(duration_s / interval_s));
    for (std::uint64_t row = 0; row < rows; ++row)
        propagator.add({motion.increment(static_cast<Wide>(row) * interval_s, interval_s), interval_s});
    return angle_between(propagator.attitude(), motion.attitude(static_cast<Wide>(rows) * interval_s));
}

inline double deg_per_hour(double error_rad, double duration_s)
{
    return error_rad * 180 / std::numbers::pi * 3600 / duration_s;
}

}  // namespace quorient::attitude::testing
