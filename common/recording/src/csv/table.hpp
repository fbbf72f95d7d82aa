#pragma once

#include "line_source.hpp"

#include <cstdint>
#include <optional>
#include <vector>

namespace quorient::recording::csv {

/// How a table is written.
struct Dialect {
    char delimiter = ',';         ///< ' ' = any number of blanks
    bool decimal_comma = false;   ///< never together with the delimiter ','
    bool point_thousands = false; ///< beside decimal commas: a point stands between thousands
};

/// What the points in a number can be, where commas are decimal.
enum class Points : std::uint8_t {
    none,       ///< there are none, or it is no number
    decimal,    ///< "0.010", "1.0105"
    thousands,  ///< "1.234.567", "1.234,5"
    either,     ///< "1.234"
};
Points points_of(std::string_view cell);

inline bool is_digit(char c)
{
    return c >= '0' && c <= '9';
}

/// Cells of a line. A cell between quotes may hold the delimiter; quotes and blanks around are removed.
void split_cells(std::string_view line, char delimiter, std::vector<std::string_view>& cells);

/// A number as people write it: with a decimal comma, and points between thousands, where that is the dialect. An empty cell, nan, null
/// and the like are not a number but a value that is missing: NaN. Nothing: the cell is none of these.
std::optional<double> cell_number(std::string_view cell, const Dialect& dialect);

/// A time in a cell, in nanoseconds: integers and decimals exactly, ISO 8601 with or without a zone as UTC, a time of day since midnight.
/// @param unit_ns  of a plain number
std::optional<std::int64_t> cell_time_ns(std::string_view cell, std::int64_t unit_ns, const Dialect& dialect);

/// Whether a cell is a date and a time of ISO 8601, or a time of day alone.
bool is_iso_time(std::string_view cell);
bool is_time_of_day(std::string_view cell);

}  // namespace quorient::recording::csv
