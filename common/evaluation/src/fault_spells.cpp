#include "quorient/evaluation/fault_spells.hpp"

#include "quorient/messages/meaning.hpp"

#include <algorithm>

namespace quorient::evaluation {

namespace {

bool began_within(const Spell& isolated, const Spell& fault)
{
    return isolated.axis == fault.axis && isolated.begin_s >= fault.begin_s && (!fault.end_s || isolated.begin_s < *fault.end_s);
}

}  // namespace

void Spells::update(AxisMask mask, double time_s)
{
    for (std::size_t axis = 0; axis < max_axes; ++axis) {
        const bool was = has_axis(last_, axis);
        if (has_axis(mask, axis) == was) continue;
        const auto latest = std::find_if(spells_.rbegin(), spells_.rend(), [&](const Spell& spell) { return spell.axis == axis; });
        if (was) latest->end_s = time_s;
        else if (latest != spells_.rend() && time_s - *latest->end_s < bridge_s_) latest->end_s.reset();
        else spells_.push_back({axis, time_s, std::nullopt});
    }
    last_ = mask;
}

void Reaction::update(const FaultVerdict& verdict, AxisMask faulty, double time_s)
{
    if (!detected_s && sees_fault(verdict)) detected_s = time_s;
    if (!isolated_s && (verdict.isolated_mask & faulty) != 0) {
        isolated_s = time_s;
        isolated = verdict.isolated_mask;
    }
}

Reaction reaction(const Spell& fault, const Spells& isolated)
{
    for (const Spell& spell : isolated.all())
        if (began_within(spell, fault))
            return {.detected_s = {}, .isolated_s = spell.begin_s, .trusted_s = spell.end_s, .isolated = axis_bit(spell.axis)};
    return {};
}

std::vector<Spell> false_isolations(const Spells& faults, const Spells& isolated)
{
    std::vector<Spell> without_cause;
    for (const Spell& spell : isolated.all()) {
        const bool caused = std::any_of(faults.all().begin(), faults.all().end(), [&](const Spell& f) { return began_within(spell, f); });
        if (!caused) without_cause.push_back(spell);
    }
    return without_cause;
}

}  // namespace quorient::evaluation
