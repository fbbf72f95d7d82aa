#include "quorient/fdi/noise.hpp"

#include <fmt/format.h>
#include <boost/math/distributions/chi_squared.hpp>
#include <boost/math/distributions/normal.hpp>
#include <cmath>

namespace quorient::fdi {

namespace {

/// Standard deviation of white noise and of the quantiser, before they are combined.
tl::expected<void, std::string> require_noise(const geometry::SensorCluster& cluster, std::string_view setting)
{
    for (Eigen::Index axis = 0; axis < cluster.axes.rows(); ++axis)
        if (!(cluster.sigma(axis) > 0 || cluster.quantum(axis) > 0))
            return tl::unexpected(
                fmt::format("axis {} has neither a noise sigma nor a quantum: set {} (rad of one increment), or sigma in the "
                            "cluster's description",
                            axis, setting));
    return {};
}

}  // namespace

double chi_square_quantile(unsigned dof, double tail)
{
    if (dof == 0) return 0;
    return boost::math::quantile(boost::math::complement(boost::math::chi_squared(dof), tail));
}

double normal_quantile(double tail)
{
    return boost::math::quantile(boost::math::complement(boost::math::normal(), tail));
}

tl::expected<geometry::AxisVector, std::string> sigma_of_axes(const DetectorSettings& settings, const geometry::SensorCluster& cluster)
{
    const Eigen::Index n = cluster.axes.rows();
    if (settings.sigma) return geometry::AxisVector(geometry::AxisVector::Constant(n, *settings.sigma));
    if (const auto known = require_noise(cluster, "sigma"); !known) return tl::unexpected(known.error());
    return geometry::AxisVector((cluster.sigma.array().square() + cluster.quantum.array().square() / 6).sqrt());
}

tl::expected<geometry::AxisVector, std::string> bound_of_axes(const DetectorSettings& settings, const geometry::SensorCluster& cluster)
{
    const Eigen::Index n = cluster.axes.rows();
    if (settings.bound) return geometry::AxisVector(geometry::AxisVector::Constant(n, *settings.bound));
    if (const auto known = require_noise(cluster, "bound"); !known) return tl::unexpected(known.error());
    const auto pfa = false_alarm_probability(settings);
    if (!pfa) return tl::unexpected(pfa.error());
    return geometry::AxisVector(normal_quantile(*pfa / (2.0 * static_cast<double>(n))) * cluster.sigma + cluster.quantum);
}

tl::expected<double, std::string> false_alarm_probability(const DetectorSettings& settings)
{
    const double pfa = settings.pfa.value_or(default_false_alarm_probability);
    if (!settings::probability.hold(pfa)) return tl::unexpected(settings::out_of_bounds("pfa", settings::probability, "", pfa));
    return pfa;
}

tl::expected<void, std::string> require_axes(const geometry::SensorCluster& cluster, std::size_t least, std::string_view method)
{
    if (cluster.size() >= least) return {};
    return tl::unexpected(fmt::format("{} needs at least {} axes, this cluster has {}", method, least, cluster.size()));
}

tl::expected<void, std::string> check_figures(const DetectorSettings& settings)
{
    return settings::check(detector_record(), settings);
}

}  // namespace quorient::fdi
