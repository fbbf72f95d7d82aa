#pragma once

#include "quorient/design/brief.hpp"

#include <numbers>

namespace quorient::design {

inline constexpr double degree = std::numbers::pi / 180;

inline Brief single_axes(std::size_t count, Mounting mounting = FreeMounting{})
{
    Brief brief;
    brief.instruments = count;
    brief.mounting = std::move(mounting);
    return brief;
}

inline Brief triads(std::size_t count, Mounting mounting = FreeMounting{})
{
    Brief brief = single_axes(count, std::move(mounting));
    brief.axes_each = 3;
    return brief;
}

}  // namespace quorient::design
