// What the state of a field detector makes of contradictions: left out, named, degraded.

#include "field/state.hpp"

#include "field/state_rules.hpp"

#include <algorithm>
#include <cmath>

namespace quorient::fdi {
namespace {

/// A degraded instrument is reported for so long after the last sign of it.
constexpr double degraded_s = 1;

field::Blame blame_of(const field::Suspicion& suspicion)
{
    switch (suspicion.filter) {
        case field::Filter::gain: return {suspicion.component, Diagnosis::gain};
        case field::Filter::delay: return {suspicion.component, Diagnosis::delay};
        case field::Filter::bias: break;
    }
    return {suspicion.component, Diagnosis::bias};
}

}  // namespace

using field::component_count;

void FieldDetector::State::judge(const field::Suspicions& found)
{
    disturbance_ = std::max(found.disturbance, field::disturbance_memory * disturbance_);
    largest_lasting_ = std::max(largest_lasting_, found.closest);
    certainty_ = found.largest().certainty;
    const bool calm = accusations_.calm(history_.count());
    const auto proved = found.proved();
    if (proved && proved->filter == field::Filter::delay && mount_ == Mount::structure) return degrade(proved->instrument, Diagnosis::delay);
    if (const auto contradicted = found.contradicted()) contradict(*contradicted);
    if (proved) return name(proved->instrument, onset_of(proved->instrument, proved->window), blame_of(*proved));
    if (rules_.erratic) check_erratic();
    if (rules_.outside_class && calm) check_class();
}

/// Since when an instrument is left out, or else the begin of this window.
std::uint64_t FieldDetector::State::onset_of(std::size_t m, std::size_t window) const
{
    return accusations_.onset_or(m, history_.begin_of(window), history_.count());
}

void FieldDetector::State::contradict(const Suspicion& suspicion)
{
    const std::size_t m = suspicion.instrument;
    leave_out(m, onset_of(m, suspicion.window), field::Windows::frames_between_looks(suspicion.window), blame_of(suspicion));
}

/// For so many frames and the time after them.
void FieldDetector::State::leave_out(std::size_t m, std::uint64_t onset, std::uint64_t frames, const field::Blame& blame)
{
    const bool erratic = accusations_.leave_out(m, onset, frames, history_.count(), comparable());
    if (!diagnostics_.accused(m)) diagnostics_.accuse(m, blame);
    if (erratic && mount_ == Mount::board) name(m, onset, {blame.component, Diagnosis::erratic});
}

/// An instrument at its range is sound, and still of no use to the attitude while others measure more. The frame before may have ended there.
void FieldDetector::State::limit()
{
    const Pending& now = pending_[1];
    saturation_.update(now.frame, comparable(), now.consensus);
    for (std::size_t m = 0; m < array_.size(); ++m) {
        if (!saturation_.limited().has(m)) continue;
        Limited& limited = limited_[m];
        if (!is_limited(m)) limited = {pending_[0].frame.sequence, 0, 0};
        limited.until = history_.count() + 1 + frames_in(field::Accusations::calm_s);
        limited.axes |= now.frame.near_range & array_[m].mask;
    }
}

void FieldDetector::State::follow_fast_lane()
{
    const InstrumentSet compared = comparable();
    if (history_.count() == 0 || compared.size() < 3) return;
    const auto finding = fast_lane_->finding(comparison_.noise(), compared);
    if (!finding) return;
    for (std::size_t m = 0; m < array_.size(); ++m) {
        if (!compared.has(m) || (array_[m].mask & finding->axes) == 0) continue;
        leave_out(m, accusations_.onset_or(m, std::min(finding->onset, last_sequence_), history_.count()), 1, {0, Diagnosis::bias});
    }
}

void FieldDetector::State::name(std::size_t m, std::uint64_t onset, const field::Blame& blame)
{
    accusations_.name(m, onset, certainty_);
    history_.begin_again(m);
    diagnostics_.accuse(m, blame);
    const auto misled = static_cast<std::uint64_t>(std::lround(field::misled_s / cluster_.interval_s));
    if (onset <= learning_from_ + misled) forget_learned();
    else comparison_.learning().centre(comparable());
}

/// An instrument that was faulty from the start has misled the others' comparison: all begins again without it.
void FieldDetector::State::forget_learned()
{
    const InstrumentSet sound = comparable();
    bool rested = true;
    for (std::size_t m = 0; m < array_.size(); ++m) rested = rested && (!sound.has(m) || start_.rested(m));
    comparison_.learning().reset(rested);
    history_.begin_again();
}

void FieldDetector::State::check_erratic()
{
    const auto erratic = comparison_.erratic().finding(comparable());
    if (!erratic) return;
    if (mount_ == Mount::structure) return degrade(erratic->instrument, Diagnosis::noise);
    name(erratic->instrument, onset_of(erratic->instrument, history_.longest()), {erratic->component, Diagnosis::erratic});
}

/// Separate boxes are late or noisy without harm to the attitude.
void FieldDetector::State::degrade(std::size_t m, Diagnosis why)
{
    degraded_[m] = {why, history_.count() + frames_in(degraded_s)};
}

/// What has been learned stays within the class.
void FieldDetector::State::check_class()
{
    for (std::size_t c = 0; c < component_count; ++c)
        for (std::size_t m = 0; m < array_.size(); ++m) {
            if (!comparable().has(m)) continue;
            const field::Parameters& learned = comparison_.learning().learned(c, m);
            const double gain = learned.segment<3>(field::gain_x).cwiseAbs().maxCoeff();
            const double largest = start_.rested(m) ? figures_.largest_drift_rad_s : figures_.largest_bias_rad_s;
            if (std::abs(learned(field::bias)) <= largest && gain <= figures_.largest_gain_error) continue;
            return name(m, onset_of(m, history_.longest()), {c, gain > figures_.largest_gain_error ? Diagnosis::gain : Diagnosis::outside_class});
        }
}

void FieldDetector::State::judge_two(InstrumentSet two)
{
    const Suspicion suspicion = filters_.disagreement(comparison_.sums(), comparison_.learning(), two, history_.ages(), history_.count());
    certainty_ = suspicion.certainty;
    if (suspicion.certainty <= 1) return;
    disagreement_.renew(history_.begin_of(suspicion.window), field::Windows::frames_between_looks(suspicion.window), history_.count());
}

}  // namespace quorient::fdi
