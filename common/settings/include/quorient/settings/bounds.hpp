#pragma once

#include <limits>
#include <string>

namespace quorient::settings {

/// The values that a number may have. What is not finite is never among them.
struct Bounds {
    double lowest = -std::numeric_limits<double>::infinity();
    double highest = std::numeric_limits<double>::infinity();
    bool lowest_included = true;
    bool highest_included = true;

    bool hold(double value) const;

    /// "1 to 32", "above 0", "above 0 and below 1"; empty where every finite number may stand.
    std::string text() const;
};

inline constexpr Bounds any_number{};
inline constexpr Bounds not_negative{.lowest = 0};
inline constexpr Bounds above_zero{.lowest = 0, .lowest_included = false};
inline constexpr Bounds probability{.lowest = 0, .highest = 1, .lowest_included = false, .highest_included = false};

}  // namespace quorient::settings
