// What the state of a field detector looks like from outside.

#include "field/state.hpp"

#include <algorithm>
#include <cmath>

namespace quorient::fdi {

using field::component_count;

void FieldDetector::State::report(const Measurement& measurement, Assessment& assessment) const
{
    assessment.threshold = 1;
    assessment.statistic = certainty_;
    const InstrumentSet compared = comparable();
    assessment.outcome = !learning_begun_ || compared.size() < 2 ? Outcome::warming_up : Outcome::healthy;
    assessment.saturated = saturation_.is_common();
    for (std::size_t m = 0; m < array_.size(); ++m) accusations_.report(m, array_[m].mask, history_.count(), compared, assessment);
    report_limited(assessment);
    field::Accusations::report_suspects(assessment);
    if (assessment.outcome == Outcome::healthy && compared.size() == 2 && disagreement_.lasts(history_.count())) {
        assessment.outcome = Outcome::ambiguous;
        assessment.onset = disagreement_.onset();
        for (std::size_t m = 0; m < array_.size(); ++m)
            if (compared.has(m)) assessment.add_candidate(array_[m].mask);
    }
    if (assessment.isolated != 0) assessment.add_candidate(assessment.isolated);
    for (std::size_t axis = 0; axis < cluster_.size(); ++axis)
        if (diagnostics_.accused(cluster_.instrument[axis])) assessment.diagnosis[axis] = diagnostics_.of(axis);
    report_degraded(assessment);
    report_residuals(measurement, assessment);
}

/// Somebody always stays in use.
void FieldDetector::State::report_limited(Assessment& assessment) const
{
    const InstrumentSet compared = comparable();
    AxisMask left_out = 0;
    std::uint64_t onset = never;
    for (std::size_t m = 0; m < array_.size(); ++m) {
        if (!is_limited(m) || !compared.has(m)) continue;
        left_out |= array_[m].mask;
        onset = std::min(onset, limited_[m].onset);
    }
    if (left_out == 0 || (axes_of(compared) & ~(left_out | assessment.provisional)) == 0) return;
    assessment.provisional |= left_out;
    assessment.provisional_from = std::min(assessment.provisional_from, onset);
    for (std::size_t axis = 0; axis < cluster_.size(); ++axis)
        if (has_axis(left_out & limited_[cluster_.instrument[axis]].axes, axis)) assessment.diagnosis[axis].kind = Diagnosis::saturated;
}

void FieldDetector::State::report_degraded(Assessment& assessment) const
{
    for (std::size_t axis = 0; axis < cluster_.size(); ++axis) {
        const Degraded& degraded = degraded_[cluster_.instrument[axis]];
        if (history_.count() >= degraded.until || (assessment.provisional & axis_bit(axis)) != 0) continue;
        assessment.degraded |= axis_bit(axis);
        if (assessment.diagnosis[axis].kind == Diagnosis::none) assessment.diagnosis[axis].kind = degraded.why;
    }
}

void FieldDetector::State::report_residuals(const Measurement& measurement, Assessment& assessment) const
{
    if (pending_.count() == 0) return;
    const Pending& newest = pending_.newest();
    for (std::size_t axis = 0; axis < cluster_.size(); ++axis) {
        const std::size_t m = cluster_.instrument[axis];
        if (!newest.frame.present.has(m)) continue;
        const Eigen::Vector3d along = framing_.axes().row(static_cast<Eigen::Index>(axis)).transpose();
        const Eigen::Vector3d difference = newest.rates.col(static_cast<Eigen::Index>(m)) - newest.consensus;
        double bound = 0;
        for (std::size_t c = 0; c < component_count; ++c)
            bound += std::pow(along(static_cast<Eigen::Index>(c)) * comparison_.frame_bound(c), 2);
        assessment.residual[axis] = along.dot(difference) * measurement.interval_s;
        assessment.bound[axis] = std::sqrt(bound) * measurement.interval_s;
    }
}

}  // namespace quorient::fdi
