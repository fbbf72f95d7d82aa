// What the state of a field detector makes of contradictions: left out, named, degraded.

#include "field/state.hpp"

#include <algorithm>
#include <cmath>

namespace quorient::fdi {
namespace {

/// A suspicion counts where it exceeds what speaks against any other instrument by this factor.
constexpr double margin = 1.25;

/// How long a contradiction keeps learning off after it.
constexpr double disturbance_memory = 0.9;  ///< per frame

/// An instrument that was left out returns, and learning goes on, so long after the last contradiction.
constexpr double calm_s = 0.5;

/// A degraded instrument is reported for so long after the last sign of it.
constexpr double degraded_s = 1;

/// A fault that began no later after the first comparison has been learned from.
constexpr double misled_s = 1;

/// An instrument that is left out more than Accusation::most_returns times within this time is erratic.
constexpr double whipsaw_s = 10;

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
    disturbance_ = std::max(found.disturbance, disturbance_memory * disturbance_);
    largest_lasting_ = std::max(largest_lasting_, found.closest);
    const Suspicion& top = found.lasting.certainty > found.brief.certainty ? found.lasting : found.brief;
    certainty_ = top.certainty;
    const bool calm = frames_ >= calm_from_;
    const Suspicion& proved = found.lasting;
    const bool is_proof = proved.certainty > 1 && proved.certainty > margin * found.lasting_against_others(proved.instrument);
    if (is_proof && proved.filter == field::Filter::delay && mount_ == Mount::structure)
        return degrade(proved.instrument, Diagnosis::delay);
    if (top.certainty > 1 && top.certainty > margin * found.against_others(top.instrument)) contradict(top);
    if (is_proof) {
        return name(proved.instrument, onset_of(proved.instrument, proved.window), blame_of(proved));
    }
    if (rules_.erratic) check_erratic();
    if (rules_.outside_class && calm) check_class();
}

/// Since when an instrument is left out, or else the begin of this window.
std::uint64_t FieldDetector::State::onset_of(std::size_t m, std::size_t window) const
{
    const bool known = is_left_out(m) && accusations_[m].onset != never;
    return known ? accusations_[m].onset : begin_of(window);
}

void FieldDetector::State::contradict(const Suspicion& suspicion)
{
    const std::size_t m = suspicion.instrument;
    leave_out(m, onset_of(m, suspicion.window), field::MatchedFilters::frames_between_looks(suspicion.window), blame_of(suspicion));
}

/// For so many frames and the time after them.
void FieldDetector::State::leave_out(std::size_t m, std::uint64_t onset, std::uint64_t frames, const field::Blame& blame)
{
    Accusation& accused = accusations_[m];
    const bool begins = !is_left_out(m);
    accused.onset = onset;
    accused.left_out_until = std::max(accused.left_out_until, frames_ + frames + frames_in(calm_s));
    calm_from_ = frames_ + frames_in(calm_s);
    keep_two(m);
    if (!diagnostics_.accused(m)) diagnostics_.accuse(m, blame);
    if (begins && comes_and_goes(accused) && mount_ == Mount::board) name(m, onset, {blame.component, Diagnosis::erratic});
}

void FieldDetector::State::follow_fast_lane()
{
    const InstrumentSet compared = comparable();
    if (frames_ == 0 || compared.size() < 3) return;
    const auto finding = fast_lane_->finding(comparison_.noise(), compared);
    if (!finding) return;
    for (std::size_t m = 0; m < array_.size(); ++m) {
        if (!compared.has(m) || (array_[m].mask & finding->axes) == 0) continue;
        const bool known = is_left_out(m) && accusations_[m].onset != never;
        leave_out(m, known ? accusations_[m].onset : std::min(finding->onset, last_sequence_), 1, {0, Diagnosis::bias});
    }
}

/// Counts a contradiction that begins. @returns whether there are too many of them.
bool FieldDetector::State::comes_and_goes(Accusation& accused) const
{
    std::uint64_t& oldest = accused.begun[accused.contradictions % accused.begun.size()];
    const bool too_many = accused.contradictions >= accused.begun.size() && frames_ - oldest < frames_in(whipsaw_s);
    oldest = frames_;
    ++accused.contradictions;
    return too_many;
}

/// At least two instruments stay in use: the newest accusation is the best founded one.
void FieldDetector::State::keep_two(std::size_t accused)
{
    std::size_t in_use = 0;
    const InstrumentSet compared = comparable();
    for (std::size_t m = 0; m < array_.size(); ++m) in_use += compared.has(m) && !is_left_out(m) ? 1 : 0;
    for (std::size_t m = 0; m < array_.size() && in_use < 2; ++m) {
        if (m == accused || !compared.has(m) || !is_left_out(m)) continue;
        accusations_[m].left_out_until = 0;
        ++in_use;
    }
}

void FieldDetector::State::name(std::size_t m, std::uint64_t onset, const field::Blame& blame)
{
    Accusation& accused = accusations_[m];
    accused.named = true;
    accused.onset = onset;
    ages_[m] = 0;
    diagnostics_.accuse(m, blame);
    const auto misled = static_cast<std::uint64_t>(std::lround(misled_s / cluster_.interval_s));
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
    ages_.fill(0);
}

void FieldDetector::State::check_erratic()
{
    const auto erratic = comparison_.erratic().finding(comparable());
    if (!erratic) return;
    if (mount_ == Mount::structure) return degrade(erratic->instrument, Diagnosis::noise);
    name(erratic->instrument, onset_of(erratic->instrument, oldest_kept()), {erratic->component, Diagnosis::erratic});
}

/// Separate boxes are late or noisy without harm to the attitude.
void FieldDetector::State::degrade(std::size_t m, Diagnosis why)
{
    degraded_[m] = {why, frames_ + frames_in(degraded_s)};
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
            return name(m, onset_of(m, oldest_kept()), {c, gain > figures_.largest_gain_error ? Diagnosis::gain : Diagnosis::outside_class});
        }
}

void FieldDetector::State::judge_two(InstrumentSet two)
{
    const Suspicion suspicion = filters_.disagreement(comparison_.sums(), comparison_.learning(), two, ages_, frames_);
    certainty_ = suspicion.certainty;
    if (suspicion.certainty <= 1) return;
    if (frames_ > disagreement_until_) disagreement_onset_ = begin_of(suspicion.window);
    disagreement_until_ = std::max(disagreement_until_, frames_ + field::MatchedFilters::frames_between_looks(suspicion.window));
}

}  // namespace quorient::fdi
