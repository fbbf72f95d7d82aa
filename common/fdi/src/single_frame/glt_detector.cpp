#include "single_frame/glt_detector.hpp"

#include "quorient/fdi/noise.hpp"

#include <utility>

namespace quorient::fdi {

tl::expected<std::unique_ptr<GltDetector>, std::string> GltDetector::make(const DetectorSettings& settings,
                                                                                  const geometry::SensorCluster& cluster)
{
    if (const auto figures = check_figures(settings); !figures) return tl::unexpected(figures.error());
    if (const auto enough = require_axes(cluster, 4, "glt"); !enough) return tl::unexpected(enough.error());
    const auto sigma = sigma_of_axes(settings, cluster);
    if (!sigma) return tl::unexpected(sigma.error());
    const SingleFaultRule rule(settings.pfa.value_or(default_false_alarm_probability), settings.margin.value_or(0));
    return std::unique_ptr<GltDetector>(new GltDetector(cluster, *sigma, rule));
}

GltDetector::GltDetector(const geometry::SensorCluster& cluster, geometry::AxisVector sigma, SingleFaultRule rule)
    : FrameDetector(cluster),
      sigma_(std::move(sigma)),
      rule_(rule),
      parity_(cluster.axes, sigma_),
      residual_(geometry::AxisVector::Zero(sigma_.size())),
      explained_(residual_)
{
}

double GltDetector::parity(std::size_t axis) const
{
    const auto i = static_cast<Eigen::Index>(axis);
    return parity_.space().sees(i) ? residual_(i) / (parity_.space().projector()(i, i) * parity_.weight()(i)) : 0;
}

void GltDetector::form(AxisMask working)
{
    parity_ = WeightedParity(cluster().axes, sigma_, working);
}

void GltDetector::judge(const geometry::AxisVector& z, Assessment& assessment)
{
    const geometry::AxisVector parity = parity_.parity(z);
    residual_ = parity_.residual(parity);
    for (Eigen::Index axis = 0; axis < z.size(); ++axis) {
        explained_(axis) = parity_.space().sees(axis) ? residual_(axis) * residual_(axis) / parity_.space().projector()(axis, axis) : 0;
        assessment.residual[static_cast<std::size_t>(axis)] = residual_(axis) / parity_.weight()(axis);
    }
    rule_.judge(parity_, parity.squaredNorm(), explained_, assessment);
}

std::vector<Detail> GltDetector::details(const Assessment&) const
{
    std::vector<double> per_axis;
    std::vector<double> parities;
    std::size_t best = 0;
    for (std::size_t axis = 0; axis < static_cast<std::size_t>(explained_.size()); ++axis) {
        per_axis.push_back(explained(axis));
        parities.push_back(parity(axis));
        if (explained(axis) > explained(best)) best = axis;
    }
    return {{"per_axis", per_axis}, {"bias_estimate", parities[best]}, {"parity", parities}};
}

}  // namespace quorient::fdi
