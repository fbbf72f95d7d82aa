#pragma once

#include "quorient/messages/limits.hpp"

#include <array>
#include <cstdint>

namespace quorient::fdi {

/// The members of a mask in ascending order.
struct MaskMembers {
    explicit MaskMembers(AxisMask mask)
    {
        for (std::size_t axis = 0; axis < 32; ++axis)
            if (has_axis(mask, axis)) item[count++] = static_cast<std::uint8_t>(axis);
    }

    const std::uint8_t* begin() const { return item.data(); }
    const std::uint8_t* end() const { return item.data() + count; }

    std::array<std::uint8_t, 32> item{};
    std::size_t count = 0;
};

/// Calls visit(subset) for every subset of `size` members of `set`, in lexicographic order of the members.
template <class Visit>
void for_each_subset(AxisMask set, std::size_t size, Visit visit)
{
    const MaskMembers members(set);
    if (size > members.count) return;
    std::array<std::size_t, 32> place{};
    for (std::size_t k = 0; k < size; ++k) place[k] = k;
    while (true) {
        AxisMask subset = 0;
        for (std::size_t k = 0; k < size; ++k) subset |= axis_bit(members.item[place[k]]);
        visit(subset);

        std::size_t last = size;  // the last place that can still move on
        while (last > 0 && place[last - 1] == members.count - size + last - 1) --last;
        if (last == 0) return;
        ++place[last - 1];
        for (std::size_t k = last; k < size; ++k) place[k] = place[k - 1] + 1;
    }
}

/// n over k.
constexpr std::size_t binomial(std::size_t n, std::size_t k)
{
    if (k > n) return 0;
    std::size_t value = 1;
    for (std::size_t i = 1; i <= k; ++i) value = value * (n - k + i) / i;
    return value;
}

}  // namespace quorient::fdi
