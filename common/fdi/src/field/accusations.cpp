#include "field/accusations.hpp"

#include <algorithm>

namespace quorient::fdi::field {

void Accusations::reset()
{
    of_.fill({});
    calm_from_ = 0;
}

bool Accusations::leave_out(std::size_t m, std::uint64_t onset, std::uint64_t frames, std::uint64_t now, InstrumentSet compared)
{
    Accusation& accused = of_[m];
    const bool begins = !left_out(m, now);
    accused.onset = onset;
    accused.left_out_until = std::max(accused.left_out_until, now + frames + calm_frames_);
    calm_from_ = now + calm_frames_;
    keep_in_use(m, now, compared);
    return begins && comes_and_goes(accused, now);
}

/// Counts a contradiction that begins. @returns whether there are too many of them.
bool Accusations::comes_and_goes(Accusation& accused, std::uint64_t now) const
{
    std::uint64_t& oldest = accused.begun[accused.contradictions % accused.begun.size()];
    const bool too_many = accused.contradictions >= accused.begun.size() && now - oldest < whipsaw_frames_;
    oldest = now;
    ++accused.contradictions;
    return too_many;
}

/// The newest accusation is the best founded one.
void Accusations::keep_in_use(std::size_t accused, std::uint64_t now, InstrumentSet compared)
{
    std::size_t in_use = 0;
    for (std::size_t m = 0; m < members_; ++m) in_use += compared.has(m) && !left_out(m, now) ? 1 : 0;
    for (std::size_t m = 0; m < members_ && in_use < least_in_use_; ++m) {
        if (m == accused || !compared.has(m) || !left_out(m, now)) continue;
        of_[m].left_out_until = 0;
        ++in_use;
    }
}

void Accusations::report(std::size_t m, AxisMask axes, std::uint64_t now, InstrumentSet compared, Assessment& assessment) const
{
    if (named(m)) {
        assessment.outcome = Outcome::isolated;
        assessment.isolated |= axes;
        assessment.onset = std::min(assessment.onset, onset(m));
        assessment.statistic = std::max(assessment.statistic, of_[m].certainty);
    } else if (!left_out(m, now) || !compared.has(m)) {
        return;
    }
    assessment.provisional |= axes;
    assessment.provisional_from = std::min(assessment.provisional_from, onset(m));
}

void Accusations::report_suspects(Assessment& assessment)
{
    if (assessment.outcome != Outcome::healthy || assessment.provisional == 0) return;
    assessment.outcome = Outcome::suspect;
    assessment.isolated = assessment.provisional;
    assessment.onset = assessment.provisional_from;
}

}  // namespace quorient::fdi::field
