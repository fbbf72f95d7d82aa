#pragma once

#include "quorient/geometry/sensor_cluster.hpp"

namespace quorient::simulation {

/// cone-4 of paper 003.
inline geometry::SensorCluster cone_4()
{
    geometry::Axes axes(4, 3);
    axes << 1, -1, 1, -1, -1, 1, -1, 1, 1, 1, 1, 1;
    axes /= std::sqrt(3.0);
    return *geometry::make_cluster(axes);
}

/// IMU1 and IMU2, aligned, 100 Hz, 2000 deg/s, with noise.
inline geometry::SensorCluster two_triads()
{
    geometry::Axes axes(6, 3);
    axes << Eigen::Matrix3d::Identity(), Eigen::Matrix3d::Identity();
    auto cluster = *geometry::make_cluster(axes, {0, 0, 0, 1, 1, 1});
    cluster.instrument_name = {"IMU1", "IMU2"};
    cluster.interval_s = 0.01;
    cluster.range.setConstant(34.9);
    cluster.sigma.setConstant(1e-5);
    return cluster;
}

}  // namespace quorient::simulation
