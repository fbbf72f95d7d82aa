#pragma once

#include "quorient/messages/limits.hpp"

#include <algorithm>
#include <array>
#include <cstdint>

namespace quorient {

/// Since which frame each axis of a cluster counts as faulty: its first contaminated sequence, `never` where it is trusted.
/// Sequences are those of one epoch. Travels as the array that it is.
struct Exclusions : std::array<std::uint64_t, max_axes> {
    /// Nothing is excluded.
    constexpr Exclusions() : std::array<std::uint64_t, max_axes>{} { fill(never); }

    /// The axes that are excluded.
    constexpr AxisMask mask() const
    {
        AxisMask axes = 0;
        for (std::size_t axis = 0; axis < max_axes; ++axis)
            if ((*this)[axis] != never) axes |= axis_bit(axis);
        return axes;
    }

    /// The axes that are excluded at this frame.
    constexpr AxisMask mask_at(std::uint64_t sequence) const
    {
        AxisMask axes = 0;
        for (std::size_t axis = 0; axis < max_axes; ++axis)
            if ((*this)[axis] <= sequence) axes |= axis_bit(axis);
        return axes;
    }

    /// The same axes in a new epoch. Its sequences start again, so what was faulty before is faulty from its first frame on.
    constexpr Exclusions in_new_epoch() const
    {
        Exclusions renewed;
        for (std::size_t axis = 0; axis < max_axes; ++axis)
            if ((*this)[axis] != never) renewed[axis] = 0;
        return renewed;
    }

    /// The exclusions of these axes alone.
    constexpr Exclusions of(AxisMask axes) const
    {
        Exclusions part;
        for (std::size_t axis = 0; axis < max_axes; ++axis)
            if (has_axis(axes, axis)) part[axis] = (*this)[axis];
        return part;
    }

    /// Excludes these axes from this sequence on, whatever was known of them.
    constexpr void exclude(AxisMask axes, std::uint64_t sequence)
    {
        for (std::size_t axis = 0; axis < max_axes; ++axis)
            if (has_axis(axes, axis)) (*this)[axis] = sequence;
    }

    /// Trusts these axes again.
    constexpr void readmit(AxisMask axes) { exclude(axes, never); }

    /// The earliest onset of these axes; `never` where none is excluded.
    constexpr std::uint64_t earliest(AxisMask axes) const
    {
        std::uint64_t sequence = never;
        for (std::size_t axis = 0; axis < max_axes; ++axis)
            if (has_axis(axes, axis)) sequence = std::min(sequence, (*this)[axis]);
        return sequence;
    }
};

static_assert(sizeof(Exclusions) == max_axes * sizeof(std::uint64_t));

}  // namespace quorient
