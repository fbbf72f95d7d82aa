#pragma once

#include "quorient/calibration/sample.hpp"
#include "quorient/messages/cluster_description.hpp"
#include "quorient/messages/codes.hpp"
#include "quorient/messages/meaning.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <random>
#include <string>
#include <vector>

namespace quorient::calibration {

inline constexpr double interval_s = 0.01;

/// What the synthetic sensors really are.
struct Truth {
    geometry::Axes axes;
    geometry::AxisVector gain;
    geometry::AxisVector bias_rad_s;
    double sigma_rad_s = 1e-3;
    double along_s = 0;
    double across_s = 0;
    double limit_rad_s = 0;  ///< 0 = none
};

/// Three triads whose axes, gains and biases differ a little from nominal.
inline Truth three_triads(std::mt19937_64& random)
{
    std::normal_distribution<double> normal;
    Truth truth;
    truth.axes.resize(9, 3);
    truth.gain.resize(9);
    truth.bias_rad_s.resize(9);
    for (Eigen::Index axis = 0; axis < 9; ++axis) {
        Eigen::RowVector3d direction = Eigen::RowVector3d::Unit(axis % 3);
        for (Eigen::Index i = 0; i < 3; ++i) direction(i) += 0.01 * normal(random);
        truth.axes.row(axis) = direction.normalized();
        truth.gain(axis) = 1.0 + 0.01 * normal(random);
        truth.bias_rad_s(axis) = 0.02 * normal(random);
    }
    return truth;
}

inline geometry::Axes nominal_axes()
{
    geometry::Axes axes(9, 3);
    axes << Eigen::Matrix3d::Identity(), Eigen::Matrix3d::Identity(), Eigen::Matrix3d::Identity();
    return axes;
}

inline ClusterDescription nominal_description()
{
    ClusterDescription description;
    description.interval_s = interval_s;
    description.kind = octet(SensorKind::gyro);
    description.axis_count = 9;
    description.instrument_count = 3;
    for (std::uint8_t axis = 0; axis < 9; ++axis) {
        description.axis[axis][axis % 3] = 1;
        description.instrument[axis] = axis / 3;
        const std::string name = "IMU" + std::to_string(axis / 3 + 1);
        std::copy(name.begin(), name.end(), description.instrument_name[axis / 3].begin());
    }
    return description;
}

/// The body: at rest for 20 s of every minute, else turning about all axes, with a smooth beginning and end.
inline Eigen::Vector3d body_rate(double t)
{
    const double moving_s = std::fmod(t, 60.0) - 20.0;
    if (moving_s < 0) return Eigen::Vector3d::Zero();
    const double strength = std::min({1.0, moving_s, 40.0 - moving_s});
    return strength * Eigen::Vector3d(6 * std::sin(7.1 * t), 5 * std::sin(9.3 * t + 1), 7 * std::sin(8.2 * t + 2));
}

inline Eigen::Vector3d body_acceleration(double t)
{
    return (body_rate(t + 1e-5) - body_rate(t - 1e-5)) / 2e-5;
}

inline std::vector<Sample> record(const Truth& truth, double duration_s, std::mt19937_64& random)
{
    std::normal_distribution<double> normal;
    std::vector<Sample> samples;
    for (std::size_t i = 1; static_cast<double>(i) * interval_s <= duration_s; ++i) {
        Sample sample;
        sample.time_s = static_cast<double>(i) * interval_s;
        sample.interval_s = interval_s;
        sample.rate.resize(truth.axes.rows());
        const Eigen::Vector3d rate = body_rate(sample.time_s);
        const Eigen::Vector3d acceleration = body_acceleration(sample.time_s);
        for (Eigen::Index instrument = 0; instrument < truth.axes.rows() / 3; ++instrument) {
            const Eigen::Vector3d along = truth.along_s * normal(random) * acceleration;
            Eigen::Vector3d across = Eigen::Vector3d::Zero();
            if (acceleration.norm() > 0) {
                const Eigen::Vector3d unit = acceleration.normalized();
                const Eigen::Vector3d noise(normal(random), normal(random), normal(random));
                across = truth.across_s * acceleration.norm() * (noise - unit * unit.dot(noise));
            }
            for (Eigen::Index k = 0; k < 3; ++k) {
                const Eigen::Index axis = 3 * instrument + k;
                double measured = truth.gain(axis) * truth.axes.row(axis).dot(rate + along + across) + truth.bias_rad_s(axis) +
                                  truth.sigma_rad_s * normal(random);
                if (truth.limit_rad_s > 0) measured = std::clamp(measured, -truth.limit_rad_s, truth.limit_rad_s);
                sample.rate(axis) = measured;
            }
        }
        samples.push_back(sample);
    }
    return samples;
}

}  // namespace quorient::calibration
