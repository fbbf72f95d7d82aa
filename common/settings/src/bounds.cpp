#include "quorient/settings/bounds.hpp"

#include <fmt/format.h>
#include <cmath>

namespace quorient::settings {

bool Bounds::hold(double value) const
{
    const bool high_enough = value > lowest || (lowest_included && value == lowest);
    const bool low_enough = value < highest || (highest_included && value == highest);
    return std::isfinite(value) && high_enough && low_enough;
}

std::string Bounds::text() const
{
    const bool from = std::isfinite(lowest);
    const bool to = std::isfinite(highest);
    if (from && to && lowest_included && highest_included) return fmt::format("{} to {}", lowest, highest);
    if (from && !to && lowest_included && lowest == 0) return "0 or more";
    const auto low = from ? fmt::format("{} {}", lowest_included ? "at least" : "above", lowest) : std::string{};
    const auto high = to ? fmt::format("{} {}", highest_included ? "at most" : "below", highest) : std::string{};
    return low + (from && to ? " and " : "") + high;
}

}  // namespace quorient::settings
