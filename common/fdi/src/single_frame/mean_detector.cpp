#include "single_frame/mean_detector.hpp"

#include "quorient/fdi/noise.hpp"
#include "single_frame/combinations.hpp"

#include <bit>
#include <cmath>
#include <utility>

namespace quorient::fdi {

namespace {

constexpr double unseen = 1e-9;  ///< a smaller diagonal element of the projector: this axis can be judged no longer

/// Residual and projector of the axes that are still in the mean. [paper 002]
struct Mean {
    geometry::AxisVector residual;
    geometry::AxisMatrix projector;
    unsigned redundancy = 0;

    void remove(Eigen::Index axis)
    {
        const geometry::AxisVector column = projector.col(axis);
        residual -= column * (residual(axis) / column(axis));
        projector -= column * column.transpose() / column(axis);
        --redundancy;
    }
};

}  // namespace

tl::expected<std::unique_ptr<MeanDetector>, std::string> MeanDetector::make(const DetectorSettings& settings, const geometry::SensorCluster& cluster)
{
    if (const auto figures = check_figures(settings); !figures) return tl::unexpected(figures.error());
    if (const auto enough = require_axes(cluster, 5, "mean"); !enough) return tl::unexpected(enough.error());
    if (settings.tolerance)
        return std::unique_ptr<MeanDetector>(new MeanDetector(settings, cluster, geometry::AxisVector::Ones(cluster.axes.rows())));
    const auto sigma = sigma_of_axes(settings, cluster);
    if (!sigma) return tl::unexpected(sigma.error() + "; or set tolerance");
    return std::unique_ptr<MeanDetector>(new MeanDetector(settings, cluster, *sigma));
}

MeanDetector::MeanDetector(const DetectorSettings& settings, const geometry::SensorCluster& cluster, geometry::AxisVector sigma)
    : FrameDetector(cluster),
      configured_tolerance_(settings.tolerance.value_or(0)),
      pfa_(settings.pfa.value_or(default_false_alarm_probability)),
      max_faults_(settings.max_faults.value_or(2)),
      bare_(settings.bare),
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
    if (assessment.isolated != 0 && !bare_) list_rivals(assessment.isolated, residual, assessment);
}

/// The axes without which the mean passes; none where it does not.
AxisMask MeanDetector::leave_out(geometry::AxisVector residual) const
{
    Mean mean{std::move(residual), parity_.space().projector(), parity_.redundancy()};
    AxisMask left_out = 0;
    for (unsigned removal = 0; removal < max_faults_ && mean.redundancy >= 2; ++removal) {
        Eigen::Index worst = -1;
        double explained = 0;
        for (Eigen::Index axis = 0; axis < mean.residual.size(); ++axis) {
            const double own = mean.projector(axis, axis);
            if (own > unseen && mean.residual(axis) * mean.residual(axis) > explained * own) {
                explained = mean.residual(axis) * mean.residual(axis) / own;
                worst = axis;
            }
        }
        if (worst < 0) return 0;
        left_out |= axis_bit(static_cast<std::size_t>(worst));
        mean.remove(worst);
        if (mean.residual.norm() <= tolerance_[mean.redundancy]) return left_out;
    }
    return 0;
}

/// Where another set of equal or smaller size passes as well: ambiguous, with all of these, the named one first.
void MeanDetector::list_rivals(AxisMask named, const geometry::AxisVector& residual, Assessment& assessment) const
{
    assessment.add_candidate(named);
    for (std::size_t size = 1; size <= static_cast<std::size_t>(std::popcount(named)); ++size)
        for_each_subset(working(), size, [&](AxisMask set) {
            Mean mean{residual, parity_.space().projector(), parity_.redundancy()};
            for (const std::size_t axis : MaskMembers(set)) {
                const auto member = static_cast<Eigen::Index>(axis);
                if (mean.projector(member, member) > unseen) mean.remove(member);
            }
            if (set != named && mean.residual.norm() <= tolerance_[mean.redundancy]) assessment.add_candidate(set);
        });
    if (assessment.candidate_count == 1) {
        assessment.candidate_count = 0;
        return;
    }
    assessment.outcome = Outcome::ambiguous;
    assessment.isolated = 0;
}

}  // namespace quorient::fdi
