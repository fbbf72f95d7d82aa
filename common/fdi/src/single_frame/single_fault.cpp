#include "single_frame/single_fault.hpp"

#include "quorient/fdi/noise.hpp"

#include <cmath>

namespace quorient::fdi {

SingleFaultRule::SingleFaultRule(double pfa, double margin) : margin_(margin)
{
    for (unsigned dof = 0; dof < max_axes; ++dof) limit_[dof] = chi_square_quantile(dof, pfa);
}

void SingleFaultRule::judge(const WeightedParity& parity, double sum_of_squares, const geometry::AxisVector& explained,
                            Assessment& assessment) const
{
    const double variance = parity.sigma() * parity.sigma();
    const unsigned q = parity.redundancy();
    assessment.statistic = sum_of_squares / variance;
    assessment.threshold = limit_[q];
    for (Eigen::Index axis = 0; axis < explained.size(); ++axis)
        assessment.bound[static_cast<std::size_t>(axis)] =
            std::sqrt(limit_[q] * variance * parity.space().projector()(axis, axis)) / parity.weight()(axis);
    if (assessment.statistic <= assessment.threshold) {
        assessment.outcome = Outcome::healthy;
        return;
    }

    Eigen::Index best = 0;
    const double most = explained.maxCoeff(&best);
    const double left = (sum_of_squares - most) / variance;
    if (q >= 2 && left > limit_[q - 1]) {
        assessment.outcome = Outcome::blind;
        return;
    }
    constexpr double rounding = 1e-9;  // aligned axes and four-axis clusters explain exactly the same
    assessment.add_candidate(axis_bit(static_cast<std::size_t>(best)));
    for (Eigen::Index axis = 0; axis < explained.size(); ++axis)
        if (axis != best && explained(axis) > 0 && explained(axis) >= most * (1 - rounding) - margin_ * variance)
            assessment.add_candidate(axis_bit(static_cast<std::size_t>(axis)));
    if (assessment.candidate_count > 1) {
        assessment.outcome = Outcome::ambiguous;
        return;
    }
    assessment.outcome = Outcome::isolated;
    assessment.isolated = assessment.candidate[0];
    assessment.candidate_count = 0;
}

}  // namespace quorient::fdi
