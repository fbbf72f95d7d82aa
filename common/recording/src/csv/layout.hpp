#pragma once

#include "column_name.hpp"
#include "quorient/recording/instrument_log.hpp"
#include "table.hpp"

#include <span>
#include <tl/expected.hpp>

namespace quorient::recording::csv {

/// Where a table keeps the values of one gyro triad.
struct GyroColumns {
    std::string name;                  ///< empty: the table names none
    std::array<std::size_t, 3> value{};
    std::array<double, 3> factor{};    ///< to rad/s, or rad for increments; 0 = the header does not say
    std::string unknown_unit;          ///< that the header names for them
    bool increments = false;
    std::optional<std::size_t> interval;
    double interval_factor = 0;        ///< to s; 0 = the header does not say
    std::optional<std::array<std::size_t, 3>> acceleration;
    double acceleration_factor = 0;    ///< to m/s^2; 0 = the header does not say
    std::optional<std::size_t> temperature;
    std::optional<std::size_t> counter;
    std::size_t time = 0;
    std::int64_t time_unit_ns = 0;     ///< 0 = the header does not say
    std::optional<std::size_t> time_fraction;  ///< nanoseconds to be added to whole seconds
    bool of_day = false;               ///< times of day without a date: they start over at midnight
    bool time_wraps = false;           ///< a 32-bit count of microseconds, as Xsens DOT's
};

/// What a header names. One triad and an identity: the long form, a row for each instrument and time.
struct Layout {
    std::vector<GyroColumns> gyros;
    std::optional<std::size_t> identity;
    std::string identity_name;
    std::size_t needed = 0;  ///< cells of a complete row
};

/// @returns an error that says what is missing; nothing at all if the cells name no gyro.
std::optional<tl::expected<Layout, std::string>> read_layout(std::span<const std::string_view> header);

/// Factor to rad/s (or rad) of a unit as ColumnName spells it; 0 = unknown.
double factor_of(std::string_view unit);
double factor_of(RateUnit unit);
std::string_view word_of(RateUnit unit);

}  // namespace quorient::recording::csv
