#pragma once

#include "quorient/fdi/settings.hpp"
#include "quorient/geometry/sensor_cluster.hpp"

#include <string>
#include <string_view>
#include <tl/expected.hpp>

namespace quorient::fdi {

/// False alarms per frame where nothing else is configured: with two of three frames to confirm, none in the life of a vehicle.
inline constexpr double default_false_alarm_probability = 1e-6;

/// x with P(chi-square of `dof` degrees > x) = tail; 0 for dof 0.
double chi_square_quantile(unsigned dof, double tail);

/// x with P(N(0,1) > x) = tail.
double normal_quantile(double tail);

/// The standard deviation of each axis's increment: settings.sigma for all, or the cluster's own sigma and quantum,
///   sigma_i^2 = noise_i^2 + quantum_i^2 / 6.
/// A quantiser that carries its remainder makes an increment the difference of two errors, each uniform in one quantum: twice q^2/12.
/// @returns which axis has neither and what to configure; a sigma that is not finite and above 0.
tl::expected<geometry::AxisVector, std::string> sigma_of_axes(const DetectorSettings& settings, const geometry::SensorCluster& cluster);

/// The largest regular error of each axis's increment: settings.bound for all, or
///   bound_i = z(1 - pfa / 2n) noise_i + quantum_i
/// (beyond which Gaussian noise on any of n axes goes with probability pfa; a carried remainder stays within one quantum).
tl::expected<geometry::AxisVector, std::string> bound_of_axes(const DetectorSettings& settings, const geometry::SensorCluster& cluster);

/// settings.pfa or the default. @returns that it is not within (0, 1).
tl::expected<double, std::string> false_alarm_probability(const DetectorSettings& settings);

/// @returns that the method needs more axes.
tl::expected<void, std::string> require_axes(const geometry::SensorCluster& cluster, std::size_t least, std::string_view method);

/// @returns that a figure that is set is not finite and above 0 (margin: not finite and at least 0).
tl::expected<void, std::string> check_figures(const DetectorSettings& settings);

}  // namespace quorient::fdi
