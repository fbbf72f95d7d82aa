#pragma once

#include "field/allowance.hpp"
#include "field/running_sums.hpp"
#include "field/window_sums.hpp"
#include "skewed/axis_parity.hpp"

namespace quorient::fdi::skewed {

/// What a sound axis may differ by: e = bias + gains' omega + delays' d omega/dt. All axes see the same regressors, so that one covariance serves
/// every direction of the parity space.
enum Parameter : Eigen::Index { bias, gain_x, gain_y, gain_z, delay_x, delay_y, delay_z, parameter_count };

using Allowance = field::Allowance<parameter_count>;
using Regressors = Allowance::Vector;

/// Templates t = [1, omega]: a bias, and, along the axis' own direction, a gain.
inline constexpr std::size_t template_count = 4;
using Direction = Eigen::Matrix<double, template_count, 1, Eigen::DontAlign>;

/// Sums over frames of what one axis contributes.
struct OneAxisSums {
    Direction deviation = Direction::Zero();                     ///< w t r, clipped
    double unclipped = 0;                                        ///< w r
    double noise = 0;                                            ///< w^2 V
    Eigen::Matrix<double, 6, 1, Eigen::DontAlign> shaped_noise = Eigen::Matrix<double, 6, 1>::Zero();  ///< w^2 omega omega' V: xx yy zz xy xz yz
};

struct AxisSums {
    double weight = 0;
    double weight_squared = 0;
    Eigen::Matrix<double, template_count, parameter_count, Eigen::DontAlign> regressors =
        Eigen::Matrix<double, template_count, parameter_count, Eigen::DontAlign>::Zero();  ///< w t phi'
    std::array<OneAxisSums, max_axes> axis{};
    std::size_t axes = 0;  ///< the others are 0

    AxisSums& operator+=(const AxisSums& other)
    {
        weight += other.weight;
        weight_squared += other.weight_squared;
        regressors += other.regressors;
        axes = std::max(axes, other.axes);
        for (std::size_t i = 0; i < other.axes; ++i) {
            axis[i].deviation += other.axis[i].deviation;
            axis[i].unclipped += other.axis[i].unclipped;
            axis[i].noise += other.axis[i].noise;
            axis[i].shaped_noise += other.axis[i].shaped_noise;
        }
        return *this;
    }

    AxisSums& operator-=(const AxisSums& other)
    {
        weight -= other.weight;
        weight_squared -= other.weight_squared;
        regressors -= other.regressors;
        for (std::size_t i = 0; i < other.axes; ++i) {
            axis[i].deviation -= other.axis[i].deviation;
            axis[i].unclipped -= other.axis[i].unclipped;
            axis[i].noise -= other.axis[i].noise;
            axis[i].shaped_noise -= other.axis[i].shaped_noise;
        }
        return *this;
    }
};

using AxisWindows = field::RunningSums<AxisSums, field::ring_length>;

}  // namespace quorient::fdi::skewed
