#include "single_frame/mean_detector.hpp"

#include "quorient/fdi/noise.hpp"

#include <algorithm>
#include <cmath>

namespace quorient::fdi {

tl::expected<std::unique_ptr<MeanDetector>, std::string> MeanDetector::make(const DetectorSettings& settings, const geometry::SensorCluster& cluster)
{
    if (const auto figures = check_figures(settings); !figures) return tl::unexpected(figures.error());
    if (const auto enough = require_axes(cluster, 5, "mean"); !enough) return tl::unexpected(enough.error());
    if (settings.tolerance) return std::unique_ptr<MeanDetector>(new MeanDetector(settings, cluster, geometry::AxisVector::Ones(cluster.axes.rows())));
    const auto sigma = sigma_of_axes(settings, cluster);
    if (!sigma) return tl::unexpected(sigma.error() + "; or set tolerance");
    return std::unique_ptr<MeanDetector>(new MeanDetector(settings, cluster, *sigma));
}

MeanDetector::MeanDetector(const DetectorSettings& settings, const geometry::SensorCluster& cluster, geometry::AxisVector sigma)
    : FrameDetector(cluster),
      configured_tolerance_(settings.tolerance.value_or(0)),
      pfa_(settings.pfa.value_or(default_false_alarm_probability)),
      max_faults_(settings.max_faults.value_or(2)),
      sigma_(std::move(sigma)),
      parity_(cluster.axes, sigma_)
{
    for (unsigned dof = 0; dof < max_axes; ++dof)
        tolerance_[dof] = configured_tolerance_ > 0 ? configured_tolerance_ : parity_.sigma() * std::sqrt(chi_square_quantile(dof, pfa_));
}

void MeanDetector::form(AxisMask working)
{
    parity_ = WeightedParity(cluster().axes, sigma_, working);
}

void MeanDetector::judge(const geometry::AxisVector& z, Assessment& assessment)
{
    const geometry::AxisVector parity = parity_.parity(z);
    const geometry::AxisVector residual = parity_.residual(parity);
    assessment.statistic = parity.norm();
    assessment.threshold = tolerance_[parity_.redundancy()];
    for (Eigen::Index axis = 0; axis < z.size(); ++axis) {
        const auto i = static_cast<std::size_t>(axis);
        assessment.residual[i] = residual(axis) / parity_.weight()(axis);
        assessment.bound[i] = assessment.threshold * std::sqrt(parity_.space().projector()(axis, axis)) / parity_.weight()(axis);
    }
    if (assessment.statistic <= assessment.threshold) {
        assessment.outcome = Outcome::healthy;
        return;
    }
    assessment.isolated = leave_out(residual);
    assessment.outcome = assessment.isolated != 0 ? Outcome::isolated : Outcome::refused;
}

/// The axes without which the mean passes; none where it does not.
AxisMask MeanDetector::leave_out(geometry::AxisVector residual) const
{
    constexpr double unseen = 1e-9;
    geometry::AxisMatrix projector = parity_.space().projector();
    AxisMask left_out = 0;
    unsigned dof = parity_.redundancy();
    for (unsigned removal = 0; removal < max_faults_ && dof >= 2; ++removal) {
        Eigen::Index worst = -1;
        double explained = 0;
        for (Eigen::Index axis = 0; axis < residual.size(); ++axis) {
            const double own = projector(axis, axis);
            if (own > unseen && residual(axis) * residual(axis) > explained * own) {
                explained = residual(axis) * residual(axis) / own;
                worst = axis;
            }
        }
        if (worst < 0) return 0;
        left_out |= axis_bit(static_cast<std::size_t>(worst));
        const geometry::AxisVector column = projector.col(worst);
        residual -= column * (residual(worst) / column(worst));
        projector -= column * column.transpose() / column(worst);
        --dof;
        if (residual.norm() <= tolerance_[dof]) return left_out;
    }
    return 0;
}

}  // namespace quorient::fdi
