#include "single_frame/parity_set_detector.hpp"

#include "quorient/fdi/noise.hpp"
#include "quorient/geometry/figures.hpp"

#include <utility>

namespace quorient::fdi {

tl::expected<std::unique_ptr<ParitySetDetector>, std::string> ParitySetDetector::make(const DetectorSettings& settings,
                                                                      const geometry::SensorCluster& cluster)
{
    if (const auto figures = check_figures(settings); !figures) return tl::unexpected(figures.error());
    if (const auto enough = require_axes(cluster, 4, "parity-set"); !enough) return tl::unexpected(enough.error());
    const auto sigma = sigma_of_axes(settings, cluster);
    if (!sigma) return tl::unexpected(sigma.error());
    const SingleFaultRule rule(settings.pfa.value_or(default_false_alarm_probability), settings.margin.value_or(0));
    return std::unique_ptr<ParitySetDetector>(new ParitySetDetector(cluster, *sigma, rule));
}

ParitySetDetector::ParitySetDetector(const geometry::SensorCluster& cluster, geometry::AxisVector sigma, SingleFaultRule rule)
    : FrameDetector(cluster), sigma_(std::move(sigma)), rule_(rule), parity_(cluster.axes, sigma_)
{
    form(cluster.all());
}

void ParitySetDetector::form(AxisMask working)
{
    parity_ = WeightedParity(cluster().axes, sigma_, working);
    matrix_ = geometry::parity_matrix(parity_.space());
    p_ = geometry::AxisVector::Zero(matrix_.rows());
}

void ParitySetDetector::judge(const geometry::AxisVector& z, Assessment& assessment)
{
    p_ = matrix_ * parity_.weight().cwiseProduct(z);
    const geometry::AxisVector residual = matrix_.transpose() * p_;  // V_i'p
    geometry::AxisVector explained(z.size());
    for (Eigen::Index axis = 0; axis < z.size(); ++axis) {
        explained(axis) = parity_.space().sees(axis) ? residual(axis) * residual(axis) / matrix_.col(axis).squaredNorm() : 0;
        assessment.residual[static_cast<std::size_t>(axis)] = residual(axis) / parity_.weight()(axis);
    }
    rule_.judge(parity_, p_.squaredNorm(), explained, assessment);
}

std::vector<Detail> ParitySetDetector::details(const Assessment&) const
{
    return {{"parity", std::vector<double>(p_.data(), p_.data() + p_.size())}};
}

}  // namespace quorient::fdi
