#include "failure_sets.hpp"

#include <algorithm>

namespace quorient::design {

std::vector<AxisMask> axes_of_units(std::span<const std::size_t> instrument, bool axes_alone)
{
    std::vector<AxisMask> units;
    for (std::size_t axis = 0; axis < instrument.size(); ++axis) {
        const std::size_t unit = axes_alone ? axis : instrument[axis];
        if (units.size() <= unit) units.resize(unit + 1, 0);
        units[unit] |= axis_bit(axis);
    }
    return units;
}

std::vector<AxisMask> failure_sets(std::span<const AxisMask> units, unsigned count)
{
    struct Choice {
        AxisMask axes = 0;
        std::size_t next = 0;  // the first unit that may join
    };
    std::vector<Choice> choices{{}};
    for (unsigned size = 0; size < count; ++size) {
        std::vector<Choice> larger;
        for (const Choice& choice : choices)
            for (std::size_t unit = choice.next; unit < units.size(); ++unit) larger.push_back({choice.axes | units[unit], unit + 1});
        choices = std::move(larger);
    }
    std::vector<AxisMask> sets;
    std::ranges::transform(choices, std::back_inserter(sets), &Choice::axes);
    return sets;
}

}  // namespace quorient::design
