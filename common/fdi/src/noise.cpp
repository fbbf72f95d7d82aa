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

tl::expected<void, std::string> require_positive(const std::optional<double>& value, std::string_view name)
{
    if (value && !(std::isfinite(*value) && *value > 0))
        return tl::unexpected(fmt::format("{} must be finite and above 0, got {}", name, *value));
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
    if (!(pfa > 0 && pfa < 1)) return tl::unexpected(fmt::format("pfa must be a probability above 0 and below 1, got {}", pfa));
    return pfa;
}

tl::expected<void, std::string> require_axes(const geometry::SensorCluster& cluster, std::size_t least, std::string_view method)
{
    if (cluster.size() >= least) return {};
    return tl::unexpected(fmt::format("{} needs at least {} axes, this cluster has {}", method, least, cluster.size()));
}

tl::expected<void, std::string> check_figures(const DetectorSettings& settings)
{
    for (const auto& [value, name] :
         {std::pair{settings.tolerance, "tolerance"}, std::pair{settings.sigma, "sigma"}, std::pair{settings.bound, "bound"},
          std::pair{settings.threshold, "threshold"}, std::pair{settings.motion_noise, "motion_noise"}})
        if (const auto positive = require_positive(value, name); !positive) return positive;
    if (settings.margin && !(std::isfinite(*settings.margin) && *settings.margin >= 0))
        return tl::unexpected(fmt::format("margin must be finite and at least 0, got {}", *settings.margin));
    if (settings.doubt && !(*settings.doubt > 0 && *settings.doubt < 1))
        return tl::unexpected(fmt::format("doubt must be a probability above 0 and below 1, got {}", *settings.doubt));
    if (settings.max_faults && *settings.max_faults == 0) return tl::unexpected(std::string("max_faults must be at least 1"));
    if (const auto pfa = false_alarm_probability(settings); !pfa) return tl::unexpected(pfa.error());
    return {};
}

}  // namespace quorient::fdi
