#pragma once

#include "quorient/recording/instrument_log.hpp"

#include <array>
#include <optional>
#include <string>
#include <vector>

namespace quorient::recording::csv {

/// Finds from a gyro's values alone in which unit they are, where the log does not state it. Three signs, each sufficient:
/// values beyond what any gyro reads in rad/s; a step between values that is the smallest of a usual sensor in one unit; gravity, whose
/// direction in the accelerometer turns by as much as the gyro says.
class RateJudge {
public:
    /// @param interval_s  since the sample before  @param acceleration  in any unit; not finite = not logged
    void add(double interval_s, const std::array<double, 3>& rate, const std::array<double, 3>& acceleration);

    struct Verdict {
        std::optional<RateUnit> unit;  ///< nothing: it cannot be determined
        std::string reason;            ///< why, in words that follow "read as deg/s, since …"; or what to do
    };

    /// What can be said now. More samples may show more.
    Verdict verdict() const;

    /// How many times as far gravity turns in the body as the rates say, taken as rad/s. Nothing: the motion does not show it.
    std::optional<double> times_of_gravity() const;

    std::size_t samples() const { return samples_; }
    bool looks_like_counts() const;

private:
    using Vector = std::array<double, 3>;

    /// Means over one stretch of about a quarter of a second.
    struct Stretch {
        Vector rate{};
        Vector acceleration{};
        double duration_s = 0;
        double samples = 0;
    };

    void compare_with_gravity(const Stretch& stretch);
    std::optional<Verdict> by_size() const;
    std::optional<Verdict> by_step() const;
    std::optional<Verdict> by_gravity() const;

    std::size_t samples_ = 0;
    double largest_ = 0;
    bool whole_numbers_ = true;
    std::array<std::vector<double>, 3> values_;  // the first ones of each axis
    Stretch current_;
    std::optional<Stretch> before_;
    double turn_squared_ = 0;   // turn of gravity's direction as the gyro has it
    double seen_squared_ = 0;   // the same as the accelerometer has it
    double common_ = 0;         // their product
    std::size_t stretches_ = 0;
};

/// The step of which all values are multiples (but for a common offset); nothing if there is none.
std::optional<double> common_step(std::vector<double> values);

}  // namespace quorient::recording::csv
