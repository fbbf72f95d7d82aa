#include "opinion.hpp"
#include "quorient/messages/meaning.hpp"

#include <algorithm>
#include <cmath>
#include <tuple>

namespace quorient::attitude {

bool Opinion::clears() const
{
    switch (state) {
        case VerdictState::healthy:
        case VerdictState::suspect:
        case VerdictState::isolated:
        case VerdictState::provisional:
            return true;
        default:
            return false;
    }
}

bool Opinion::precedes(const Opinion& other) const
{
    const auto key = [](const Opinion& o) { return std::tie(o.excluded_from, o.isolated, o.state, o.suspects, o.candidates, o.residual); };
    return key(*this) < key(other);
}

void Opinion::take_over(const Opinion& other, AxisMask axes)
{
    const AxisMask added = axes & ~isolated;
    for (std::size_t axis = 0; axis < max_axes; ++axis)
        if (has_axis(added, axis)) excluded_from[axis] = std::min(excluded_from[axis], other.excluded_from[axis]);
    taken_over |= added;
    isolated |= added;
    excluded |= added;
}

Opinion opinion_of(const FaultVerdict& verdict)
{
    Opinion opinion;
    opinion.sequence = verdict.sequence;
    opinion.excluded_from = verdict.excluded_from;
    opinion.excluded = opinion.own = verdict.excluded_from.mask();
    opinion.isolated = verdict.isolated_mask & opinion.excluded;
    opinion.suspects = verdict.suspect_mask;
    const std::size_t count = std::min<std::size_t>(verdict.candidate_count, max_candidates);
    for (std::size_t i = 0; i < count; ++i) opinion.candidates |= verdict.candidate_set[i];
    for (const double residual : verdict.residual)
        if (std::isfinite(residual)) opinion.residual = std::max(opinion.residual, std::abs(residual));
    opinion.state = state_of(verdict);
    return opinion;
}

Opinion opinion_of(const VotedAttitude& voted)
{
    Opinion opinion;
    opinion.sequence = voted.sequence;
    for (std::size_t axis = 0; axis < max_axes; ++axis)
        if (has_axis(voted.isolated_mask, axis)) opinion.excluded_from[axis] = std::min(voted.excluded_from[axis], voted.sequence);
    opinion.excluded = opinion.isolated = opinion.own = opinion.excluded_from.mask();
    opinion.state = VerdictState::isolated;
    return opinion;
}

Judgement judge(const Opinion& opinion, AxisMask excluded, AxisMask valid, bool leave_out_suspects, const BodyIncrement& body)
{
    const AxisMask trusted = valid & ~excluded;
    Judgement judgement{.used = trusted, .saturated = opinion.state == VerdictState::saturated};
    const auto leave_out = [&](AxisMask axes) {
        if (axes == 0 || !body.well_conditioned(trusted & ~axes)) return false;
        judgement.used = trusted & ~axes;
        return true;
    };
    const auto doubt = [&] { judgement.doubt_rad = std::max(opinion.residual, 3 * std::sqrt(body.solve(trusted).variance)); };
    const AxisMask suspects = opinion.suspects & ~excluded;
    const bool overruled = (excluded & ~opinion.known) != 0;  // by a later verdict, which named the fault

    if (judgement.saturated) {
        judgement.mode = AttitudeMode::untrusted;
        doubt();
    } else if (overruled) {
        // The axis that caused the suspicion is excluded, so the others are used again.
    } else if (opinion.state == VerdictState::suspect) {
        if (!leave_out_suspects || !leave_out(opinion.suspects)) doubt();
    } else if (opinion.state == VerdictState::provisional && suspects != 0) {
        if (!leave_out_suspects || !leave_out(suspects)) doubt();
    } else if (opinion.state == VerdictState::ambiguous) {
        if (!leave_out(opinion.candidates)) {
            judgement.mode = AttitudeMode::ambiguous;
            doubt();
        }
    } else if (opinion.state == VerdictState::blind) {
        judgement.mode = AttitudeMode::untrusted;
        doubt();
    }
    if (!body.solve(judgement.used).independent) judgement = {.used = 0, .mode = AttitudeMode::coasting, .saturated = judgement.saturated};
    return judgement;
}

}  // namespace quorient::attitude
