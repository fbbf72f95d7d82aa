#pragma once

#include "judges.hpp"

#include <array>
#include <optional>
#include <string>
#include <vector>

namespace quorient::studies {

inline constexpr std::array<const char*, 2> isolation_layouts{"dodecahedron", "cone-6"};

struct IsolationCase {
    const char* name;
    Faults faults;
};

inline constexpr std::array<IsolationCase, 5> isolation_cases{{
    {"0 faults", {}},
    {"1f U(5,30)s", {1, 5, 30}},
    {"2f U(5,30)s", {2, 5, 30}},
    {"1f U(20,200)s", {1, 20, 200}},
    {"2f U(20,200)s", {2, 20, 200}},
}};

/// Recomputed correct rates of a row, %; nothing where there is none.
using Published = std::array<std::array<std::optional<double>, isolation_cases.size()>, isolation_layouts.size()>;

struct IsolationRow {
    enum class Kind : std::uint8_t {
        known_count,  ///< knows the number of faults: a bound, no competitor
        assumes,      ///< takes it for granted that there are two, if any: no competitor either
        method,       ///< knows the measurement alone
        ours,         ///< a published operating point of the subset method
    };

    std::string name;
    Kind kind = Kind::method;
    JudgeFactory judge;
    Published published{};
    double published_trials = 6000;
};

/// The rows of the table "Best achievable rate", further methods of the product, and our operating points (last).
std::vector<IsolationRow> isolation_rows();

/// A setting of the subset method.
struct OperatingPoint {
    double margin = 0;
    std::optional<double> doubt;
};

/// Names whenever it can: the sequential likelihood decision.
inline constexpr OperatingPoint eager{0, {}};

/// Hardly ever names a wrong set: of the curve, the highest correct rate whose unflagged wrong isolations stay at or below
/// 0.2 %, by more than a standard error of 100 000 trials, in every case on both layouts.
inline constexpr OperatingPoint careful{10, 0.5};

/// The curve: margins without doubt, then with it.
std::vector<OperatingPoint> operating_curve();

JudgeFactory subset(const OperatingPoint& point);

}  // namespace quorient::studies
