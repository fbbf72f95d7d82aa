#pragma once

#include "quorient/messages/cluster_description.hpp"
#include "quorient/messages/codes.hpp"
#include "quorient/messages/limits.hpp"

#include <Eigen/Core>
#include <optional>
#include <string>
#include <tl/expected.hpp>
#include <vector>

namespace quorient::geometry {

/// n x 3, rows are unit vectors in the body frame. Never on the heap.
using Axes = Eigen::Matrix<double, Eigen::Dynamic, 3, Eigen::ColMajor, static_cast<int>(max_axes), 3>;

/// One value per axis. Never on the heap.
using AxisVector = Eigen::Matrix<double, Eigen::Dynamic, 1, Eigen::ColMajor, static_cast<int>(max_axes), 1>;

/// Any matrix over axes. Never on the heap.
using AxisMatrix = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::ColMajor, static_cast<int>(max_axes), static_cast<int>(max_axes)>;

/// Where the axes of one unit point, which instrument each belongs to, and how good each is.
///
/// Guaranteed by construction: 3 to 24 axes, rank 3, every norm within 1e-4 of 1 (rows are used exactly as given).
struct SensorCluster {
    Axes axes;                              ///< H
    std::vector<std::size_t> instrument;    ///< instrument of each axis
    std::vector<std::string> instrument_name;
    AxisVector sigma;    ///< noise of one increment [rad; m/s]; 0 where unknown
    AxisVector quantum;  ///< [rad; m/s]; 0 = none
    AxisVector range;    ///< [rad/s; m/s^2]; 0 = none stated
    double interval_s = 0;
    SensorKind kind = SensorKind::gyro;

    std::size_t size() const { return static_cast<std::size_t>(axes.rows()); }
    AxisMask all() const { return all_axes(size()); }
    AxisMask axes_of(std::size_t instrument_index) const;
};

/// What is wrong with one axis: not finite, or a norm off by more than 1e-4. Nothing where it is good.
std::optional<std::string> unit_norm_problem(const Eigen::RowVector3d& axis);

/// A cluster of axes alone: no noise, every axis its own instrument unless `instrument` says otherwise.
/// @returns what is wrong, naming the axis: norm off by more than 1e-4, rank below 3, not finite, fewer than 3 or more than 24.
tl::expected<SensorCluster, std::string> make_cluster(const Axes& axes, std::vector<std::size_t> instrument = {});

/// The cluster that a description on the wire stands for; refuses what make_cluster refuses and bad noise figures.
tl::expected<SensorCluster, std::string> make_cluster(const ClusterDescription& description);

}  // namespace quorient::geometry
