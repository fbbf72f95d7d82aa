#pragma once

#include "line_source.hpp"

#include <optional>
#include <vector>

namespace quorient::recording::csv {

/// How a table is written.
struct Dialect {
    char delimiter = ',';         ///< ' ' = any number of blanks
    bool decimal_comma = false;   ///< never together with the delimiter ','
};

/// Cells of a line. A cell between quotes may hold the delimiter; quotes and blanks around are removed.
void split_cells(std::string_view line, char delimiter, std::vector<std::string_view>& cells);

/// A number as people write it: with a decimal comma, and points between thousands, where that is the rule. An empty cell, nan, null and the like are not a number but
/// a value that is missing: NaN. Nothing: the cell is none of these.
std::optional<double> cell_number(std::string_view cell, bool decimal_comma);

/// A time in a cell, in nanoseconds: integers and decimals exactly, ISO 8601 with or without a zone as UTC, a time of day since midnight.
/// @param unit_ns  of a plain number
std::optional<std::int64_t> cell_time_ns(std::string_view cell, std::int64_t unit_ns, bool decimal_comma);

/// Whether a cell is a date and a time of ISO 8601, or a time of day alone.
bool is_iso_time(std::string_view cell);
bool is_time_of_day(std::string_view cell);

}  // namespace quorient::recording::csv
