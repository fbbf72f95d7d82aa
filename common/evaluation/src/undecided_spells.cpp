#include "quorient/evaluation/undecided_spells.hpp"

#include "quorient/messages/meaning.hpp"

#include <algorithm>

namespace quorient::evaluation {

namespace {

constexpr double bridge_s = 0.2;

bool is_undecided(VerdictState state)
{
    switch (state) {
        case VerdictState::suspect:
        case VerdictState::ambiguous:
        case VerdictState::blind:
        case VerdictState::provisional:
        case VerdictState::saturated: return true;
        default: return false;
    }
}

AxisMask concerned(const FaultVerdict& verdict)
{
    AxisMask axes = verdict.suspect_mask | provisional_mask(verdict);
    for (std::size_t i = 0; i < std::min<std::size_t>(verdict.candidate_count, max_candidates); ++i) axes |= verdict.candidate_set[i];
    return axes;
}

}  // namespace

void UndecidedSpells::add(const FaultVerdict& verdict)
{
    const double time_s = static_cast<double>(verdict.sample_time_ns) * 1e-9;
    const double step_s = begun_ ? std::max(0.0, time_s - newest_s_) : 0;
    newest_s_ = time_s;
    begun_ = true;
    const VerdictState state = state_of(verdict);
    if (!is_undecided(state)) return;
    total_s_[state] += step_s;
    const auto same = std::find_if(spells_.rbegin(), spells_.rend(), [&](const Spell& spell) { return spell.state == state; });
    if (same != spells_.rend() && time_s - same->to_s <= bridge_s) {
        same->to_s = time_s;
        same->axes |= concerned(verdict);
        return;
    }
    if (spells_.size() < most_spells) spells_.push_back({state, concerned(verdict), time_s, time_s});
}

}  // namespace quorient::evaluation
