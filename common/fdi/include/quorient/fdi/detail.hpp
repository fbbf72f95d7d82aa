#pragma once

#include "quorient/messages/limits.hpp"

#include <array>
#include <cstdint>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

namespace quorient::fdi {

/// A set of axes and what it is worth to the method.
struct ScoredSet {
    AxisMask axes = 0;
    double score = 0;
};

/// A figure of a method's own about its newest frame, for tools that show it. What does not exist is NaN, an empty string or `std::monostate`.
struct Detail {
    using Interval = std::array<double, 2>;
    struct Axes {
        AxisMask mask = 0;
    };
    using Value = std::variant<std::monostate, bool, std::int64_t, double, std::string, Axes, Interval, std::vector<bool>, std::vector<double>,
                               std::vector<std::string>, std::vector<Axes>, std::vector<Interval>, std::vector<ScoredSet>>;

    std::string_view name;
    Value value;
};

}  // namespace quorient::fdi
