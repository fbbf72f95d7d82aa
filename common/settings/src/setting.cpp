#include "quorient/settings/setting.hpp"

#include <fmt/format.h>
#include <cmath>

namespace quorient::settings {

std::string out_of_bounds(std::string_view key, const Bounds& bounds, std::string_view unit, double value)
{
    const auto allowed = bounds.text();
    const std::string_view finite = std::isfinite(value) ? "" : allowed.empty() ? "finite" : "finite and ";
    return fmt::format("{} must be {}{}{}, got {}", key, finite, allowed, unit.empty() ? std::string{} : fmt::format(" [{}]", unit), value);
}

}  // namespace quorient::settings
