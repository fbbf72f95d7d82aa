// What the state of a skewed detector makes of contradictions, and what it looks like from outside.

#include "field/state_rules.hpp"
#include "skewed/state.hpp"

#include <algorithm>
#include <cmath>

namespace quorient::fdi {
namespace {

Diagnosis kind_of(field::Filter filter)
{
    return filter == field::Filter::gain ? Diagnosis::gain : Diagnosis::bias;
}

}  // namespace

void SkewedDetector::State::judge(const field::Suspicions& found)
{
    disturbance_ = std::max(found.disturbance, field::disturbance_memory * disturbance_);
    largest_lasting_ = std::max(largest_lasting_, found.closest);
    certainty_ = found.largest().certainty;
    const bool calm = accusations_.calm(history_.count());
    const auto proved = found.proved();
    const auto contradicted = found.contradicted();
    if (contradicted) leave_out(*contradicted);
    // Whatever part of another axis' fault looks like one of this axis: that one is contradicted more, even where it does not last yet.
    if (proved && contradicted && contradicted->instrument == proved->instrument) {
        const std::size_t axis = proved->instrument;
        return name(axis, accusations_.onset_or(axis, history_.begin_of(proved->window), history_.count()), kind_of(proved->filter));
    }
    if (found.lasting.certainty > 1) {
        AxisSet candidates;
        for (std::size_t i = 0; i < cluster_.size(); ++i)
            if (found.lasting_of[i] * field::Windows::margin >= found.lasting.certainty) candidates.add(i);
        disagree(candidates, found.lasting.window);
    }
    if (rules_.erratic) check_erratic();
    if (rules_.outside_class && calm) check_class();
}

/// Several axes explain alike what cannot be explained without a fault.
void SkewedDetector::State::disagree(AxisSet candidates, std::size_t window)
{
    disagreement_.renew(history_.begin_of(window), field::Windows::frames_between_looks(window), history_.count());
    candidates_ = candidates;
}

void SkewedDetector::State::judge_last_parity()
{
    const AxisSet compared = comparable();
    comparison_.wander(framing_.interval_s());
    const field::Suspicion suspicion =
        filters_.disagreement(comparison_.sums(), comparison_.allowance(), compared, history_.ages(), history_.count());
    certainty_ = suspicion.certainty;
    if (suspicion.certainty > 1) disagree(compared, suspicion.window);
}

void SkewedDetector::State::leave_out(const field::Suspicion& suspicion)
{
    const std::size_t axis = suspicion.instrument;
    const std::uint64_t onset = accusations_.onset_or(axis, history_.begin_of(suspicion.window), history_.count());
    const bool erratic =
        accusations_.leave_out(axis, onset, field::Windows::frames_between_looks(suspicion.window), history_.count(), comparable());
    if (!accused_[axis].fit.begun()) accuse(axis, kind_of(suspicion.filter));
    if (erratic) name(axis, onset, Diagnosis::erratic);
}

void SkewedDetector::State::name(std::size_t axis, std::uint64_t onset, Diagnosis why)
{
    accusations_.name(axis, onset, certainty_);
    history_.begin_again(axis);
    accuse(axis, why);
    if (onset <= learning_from_ + static_cast<std::uint64_t>(std::lround(field::misled_s / cluster_.interval_s))) forget_learned();
}

/// An axis that was faulty from the start has misled the others' comparison: all begins again without it.
void SkewedDetector::State::forget_learned()
{
    const AxisSet sound = comparable();
    bool rested = true;
    for (std::size_t i = 0; i < cluster_.size(); ++i) rested = rested && (!sound.has(i) || start_.rested(i));
    comparison_.begin(rested);
    history_.begin_again();
}

void SkewedDetector::State::accuse(std::size_t axis, Diagnosis why)
{
    Accused& accused = accused_[axis];
    if (accused.fit.begun()) {
        if (why != Diagnosis::none) accused.blamed_for = why;
        return;
    }
    accused.blamed_for = why;
    accused.fit.begin(cluster_.axes.row(static_cast<Eigen::Index>(axis)).transpose(), figures_.noise_floor_rad_s);
    accused.diagnosis = {};
    accused.diagnosis.kind = why;
}

void SkewedDetector::State::acquit(std::size_t axis)
{
    accused_[axis].fit.forget();
    accused_[axis].diagnosis = {};
}

void SkewedDetector::State::check_erratic()
{
    const auto erratic = comparison_.erratic().finding(comparable());
    if (erratic)
        name(erratic->instrument, accusations_.onset_or(erratic->instrument, history_.begin_of(history_.longest()), history_.count()),
             Diagnosis::erratic);
}

/// What has been learned stays within the class.
void SkewedDetector::State::check_class()
{
    const skewed::AxisParity& parity = parity_of(comparable());
    if (parity.redundancy() < 2) return;
    for (Eigen::Index parameter = skewed::bias; parameter <= skewed::gain_z; ++parameter) {
        skewed::PerAxis learned{};
        for (std::size_t i = 0; i < cluster_.size(); ++i)
            if (parity.set().has(i)) learned[i] = comparison_.learned(i)(parameter);
        const auto outside = outside_class(parameter, parity.residual(learned), parity);
        if (!outside) continue;
        return name(*outside, accusations_.onset_or(*outside, history_.begin_of(history_.longest()), history_.count()),
                    parameter == skewed::bias ? Diagnosis::outside_class : Diagnosis::gain);
    }
}

/// The axis whose learned parameter lies outside the class, if no other axis explains it nearly as well.
std::optional<std::size_t> SkewedDetector::State::outside_class(Eigen::Index parameter, const skewed::PerAxis& residual,
                                                                const skewed::AxisParity& parity) const
{
    std::optional<std::size_t> outside;
    double most = 0;
    double second = 0;
    for (std::size_t i = 0; i < cluster_.size(); ++i) {
        if (!parity.set().has(i) || !parity.sees(i)) continue;
        const double largest_bias = start_.rested(i) ? figures_.largest_drift_rad_s : figures_.largest_bias_rad_s;
        const double largest = parameter == skewed::bias ? largest_bias : figures_.largest_gain_error;
        const auto [along, others] = parity.split(i, residual);
        const double rho = field::Windows::scatter_factor(parity.redundancy() - 1) * std::sqrt(parity.share(i, i));
        const double times = std::abs(along) / (std::sqrt(skewed::of_three) * largest + rho * others);
        second = std::max(second, std::min(times, most));
        if (times <= most) continue;
        most = times;
        outside = i;
    }
    return most > std::max(1.0, field::Windows::margin * second) ? outside : std::nullopt;
}

void SkewedDetector::State::report(const Measurement& measurement, Assessment& assessment) const
{
    assessment.threshold = 1;
    assessment.statistic = certainty_;
    const AxisSet compared = comparable();
    assessment.outcome = !learning_begun_ || compared.size() < 4 ? Outcome::warming_up : Outcome::healthy;
    const AxisSet within = compared - saturation_.blind();
    assessment.saturated = !saturation_.blind().empty() && !skewed::spans_space(cluster_.axes, within);
    for (std::size_t i = 0; i < cluster_.size(); ++i) {
        assessment.diagnosis[i] = accused_[i].diagnosis;
        accusations_.report(i, axis_bit(i), history_.count(), compared, assessment);
    }
    field::Accusations::report_suspects(assessment);
    if (assessment.outcome == Outcome::healthy && disagreement_.lasts(history_.count())) {
        assessment.outcome = Outcome::ambiguous;
        assessment.onset = disagreement_.onset();
        for (std::size_t i = 0; i < cluster_.size(); ++i)
            if (candidates_.has(i) && compared.has(i)) assessment.add_candidate(axis_bit(i));
    }
    if (assessment.isolated != 0) assessment.add_candidate(assessment.isolated);
    if (pending_.count() < 2) return;
    for (std::size_t i = 0; i < cluster_.size(); ++i) {
        assessment.residual[i] = comparison_.residual()[i] * measurement.interval_s;
        assessment.bound[i] = comparison_.frame_bound() * measurement.interval_s;
    }
}

}  // namespace quorient::fdi
