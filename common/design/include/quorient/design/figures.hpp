#pragma once

#include "quorient/design/brief.hpp"
#include "quorient/design/fault_size.hpp"

#include <optional>
#include <string_view>
#include <vector>

namespace quorient::design {

/// The worst case over all sets of so many failures, each figure on its own; infinite where some set leaves no three directions.
struct AfterFailures {
    unsigned failures = 0;
    double trace = 0;
    double volume = 0;
    double condition = 0;
};

/// The probability of reaching the end of the mission, and the standard error of its Monte Carlo.
struct Survival {
    double probability = 0;
    double standard_error = 0;
    /// Share of the first, second, … failures that were isolated rightly, among missions that got there; NaN where none did.
    std::vector<double> coverage;
};

/// What an array is worth. Accuracies are of the least-squares body vector, in the square of the noise's unit. NaN where undefined.
struct Figures {
    double trace = 0;
    double volume = 0;
    double condition = 0;
    double minimum_angle_rad = 0;  ///< between axes as lines
    std::vector<AfterFailures> worst_after;
    double f_d1 = 0;
    double f_d2 = 0;
    unsigned detectable = 0;  ///< simultaneous faults of any size, of axes or (instrument_faults) instruments
    unsigned isolable = 0;
    FaultSizes fault;                             ///< on single axes
    std::optional<double> mounted_trace{};        ///< after the judged failures, the worst of many random mountings
    std::optional<Survival> survival{};
};

/// How an array is judged.
struct Yardstick {
    geometry::AxisVector noise;  ///< for each axis
    std::vector<std::size_t> instrument;
    bool instrument_faults = false;
    unsigned failures = 0;          ///< figures after 1 .. this many
    double mounting_error_rad = 0;  ///< 0: not considered
    std::uint64_t seed = 1;         ///< draws the random mountings
    bool fault_sizes = true;        ///< else they are NaN
    Probabilities probabilities{};

    static Yardstick of(const Brief& brief, std::uint64_t seed);

    /// All axes alike, single ones or the cluster's instruments.
    static Yardstick of(const geometry::SensorCluster& cluster, unsigned failures);
};

/// All figures but the survival, which mission.hpp adds.
Figures judge(const geometry::Axes& axes, const Yardstick& yardstick);

inline constexpr unsigned random_mountings = 200;

enum class Objective : std::uint8_t {
    trace,
    volume,
    condition,
    worst_trace,
    worst_volume,
    worst_condition,
    minimum_angle,
    f_d1,
    f_d2,
    detected_axis,
    isolated_axis,
    detected_pair,
    isolated_pair,
    mounted_trace,
    survival,
};

struct ObjectiveEntry {
    Objective objective;
    std::string_view name;     ///< as the user types it
    std::string_view summary;  ///< one line
    std::string_view source;
};

/// Whether the objective is one of FaultSizes.
bool is_fault_size(Objective objective);

/// The one list of objectives.
const std::vector<ObjectiveEntry>& objectives();

/// The figure of this objective, turned so that less is better; undefined is infinite. The worst cases are those after the most failures.
double cost(const Figures& figures, Objective objective);

/// cost(judge(axes, yardstick), objective), reckoning nothing else; not for the survival.
double single_cost(const geometry::Axes& axes, const Yardstick& yardstick, Objective objective);

/// `first` is better than `second` by the objective, or as good and better by what follows: trace, worst trace after 1, 2, … failures,
/// F_d2, smallest angle. Figures that agree to 8 digits count as equal.
bool better(const Figures& first, const Figures& second, Objective objective);

/// `first` is as good as `second` in the objective, trace, worst traces, F_d2 and smallest angle, each to a hundredth.
bool as_good(const Figures& first, const Figures& second, Objective objective);

/// How many failures of units, one after another, parity names whatever their sizes: a failure is named if two more may be missing.
/// On exactly four axes the prediction of the motion names one more, which is not counted here.
unsigned named_in_turn(const Figures& figures);

/// Whether the failures of the brief are named one after another, by parity or, on exactly four axes, by prediction.
bool names_failures(const Figures& figures, const Brief& brief);

/// By how much the figures miss the brief's limits: 0 where all hold.
double shortfall(const Figures& figures, const Brief& brief);

}  // namespace quorient::design
