#include "table.hpp"

#include "stamps.hpp"

#include <algorithm>
#include <array>
#include <charconv>
#include <chrono>
#include <cmath>
#include <limits>

namespace quorient::recording::csv {
namespace {

std::string_view unquoted(std::string_view cell)
{
    cell = trimmed(cell);
    if (cell.size() >= 2 && cell.front() == '"' && cell.back() == '"') cell = trimmed(cell.substr(1, cell.size() - 2));
    return cell;
}

/// Reads `count` digits and takes them off; nothing if there are fewer.
std::optional<int> take_digits(std::string_view& text, std::size_t count)
{
    if (text.size() < count || !std::all_of(text.begin(), text.begin() + static_cast<std::ptrdiff_t>(count), is_digit)) return std::nullopt;
    int value = 0;
    std::from_chars(text.data(), text.data() + count, value);
    text.remove_prefix(count);
    return value;
}

bool take(std::string_view& text, std::string_view any_of)
{
    if (text.empty() || any_of.find(text.front()) == std::string_view::npos) return false;
    text.remove_prefix(1);
    return true;
}

/// Digits behind a decimal point as nanoseconds; taken off.
std::int64_t take_fraction_ns(std::string_view& text)
{
    std::int64_t ns = 0;
    std::int64_t place = 100'000'000;
    while (!text.empty() && is_digit(text.front())) {
        ns += (text.front() - '0') * place;
        place /= 10;
        text.remove_prefix(1);
    }
    return ns;
}

/// "Z", "+02:00", "+0200", or nothing. @returns seconds east of Greenwich; nothing if it is none of these.
std::optional<int> zone_s(std::string_view text)
{
    if (text.empty() || text == "Z" || text == "z") return 0;
    const int sign = text.front() == '-' ? -1 : 1;
    if (!take(text, "+-")) return std::nullopt;
    const auto hours = take_digits(text, 2);
    take(text, ":");
    const auto minutes = text.empty() ? std::optional(0) : take_digits(text, 2);
    if (!hours || !minutes || !text.empty()) return std::nullopt;
    return sign * (*hours * 3600 + *minutes * 60);
}

std::optional<std::int64_t> iso_time_ns(std::string_view text)
{
    using namespace std::chrono;
    const auto years = take_digits(text, 4);
    const bool dashes = take(text, "-/");
    const auto months = take_digits(text, 2);
    if (dashes && !take(text, "-/")) return std::nullopt;
    const auto days_of_month = take_digits(text, 2);
    if (!years || !months || !days_of_month || !take(text, "Tt ")) return std::nullopt;
    const auto hours_of_day = take_digits(text, 2);
    const bool colons = take(text, ":");
    const auto minutes_of_hour = take_digits(text, 2);
    if (!hours_of_day || !minutes_of_hour) return std::nullopt;
    std::optional<int> whole_s = 0;
    if (!colons || take(text, ":")) whole_s = take_digits(text, 2);
    const year_month_day date{year{*years}, month{static_cast<unsigned>(*months)}, day{static_cast<unsigned>(*days_of_month)}};
    if (!whole_s || !date.ok()) return std::nullopt;
    const std::int64_t fraction_ns = take(text, ".,") ? take_fraction_ns(text) : 0;
    const auto zone = zone_s(trimmed(text));
    // Years that a 64-bit count of nanoseconds does not hold are no log's.
    if (!zone || *years < 1900 || *years > 2100) return std::nullopt;
    const std::int64_t since_1970_s = sys_days{date}.time_since_epoch().count() * std::int64_t{86'400} + *hours_of_day * 3600 +
                                      *minutes_of_hour * 60 + *whole_s - *zone;
    return since_1970_s * 1'000'000'000 + fraction_ns;
}

/// "-12.25" in units of so many nanoseconds, exactly.
std::optional<std::int64_t> decimal_ns(std::string_view text, std::int64_t unit_ns)
{
    const bool negative = text.starts_with('-');
    take(text, "+-");
    std::int64_t whole = 0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), whole);
    text.remove_prefix(static_cast<std::size_t>(end - text.data()));
    if (error != std::errc{} || whole > std::numeric_limits<std::int64_t>::max() / 2 / unit_ns) return std::nullopt;
    std::int64_t ns = whole * unit_ns;
    if (take(text, ".")) {
        const std::int64_t billionths = take_fraction_ns(text);
        ns += static_cast<std::int64_t>(static_cast<double>(billionths) * 1e-9 * static_cast<double>(unit_ns) + 0.5);
    }
    if (!text.empty()) return std::nullopt;
    return negative ? -ns : ns;
}

/// A copy with a point in place of the comma, and without those between thousands. @returns nothing if the cell is longer than any number.
std::optional<std::string_view> with_point(std::string_view cell, const Dialect& dialect, std::array<char, 64>& copy)
{
    if (cell.size() > copy.size()) return std::nullopt;
    std::size_t size = 0;
    for (const char c : cell)
        if (c != '.' || !dialect.point_thousands) copy[size++] = c == ',' ? '.' : c;
    return std::string_view(copy.data(), size);
}

/// "12:34:56.789" since midnight.
std::optional<std::int64_t> time_of_day_ns(std::string_view text)
{
    const auto hours = take_digits(text, 2);
    if (!hours || !take(text, ":")) return std::nullopt;
    const auto minutes = take_digits(text, 2);
    if (!minutes || !take(text, ":")) return std::nullopt;
    const auto seconds = take_digits(text, 2);
    const std::int64_t fraction_ns = seconds && take(text, ".,") ? take_fraction_ns(text) : 0;
    if (!seconds || !text.empty() || *hours > 24 || *minutes > 59 || *seconds > 60) return std::nullopt;
    return ((*hours * std::int64_t{60} + *minutes) * 60 + *seconds) * 1'000'000'000 + fraction_ns;
}

/// Cells of a line without quotes, between delimiters that are no blanks: most lines of most logs. Cells are short, so a search for the next
/// delimiter costs more than a look at each character.
void split_plain(std::string_view line, char delimiter, std::vector<std::string_view>& cells)
{
    const auto give = [&](std::string_view cell) {
        const bool padded = !cell.empty() && (cell.front() <= ' ' || cell.back() <= ' ');
        cells.push_back(padded ? trimmed(cell) : cell);
    };
    std::size_t begin = 0;
    for (std::size_t at = 0; at < line.size(); ++at) {
        if (line[at] != delimiter) continue;
        give(line.substr(begin, at - begin));
        begin = at + 1;
    }
    give(line.substr(begin));
}

std::optional<double> missing_number(std::string_view text)
{
    for (const std::string_view missing :
         {"", "-", "--", "null", "NULL", "None", "NA", "N/A", "#N/A", "NaN", "n/a", "1.#QNAN", "-1.#IND", "1.#IND", "1.#INF", "-1.#INF"})
        if (text == missing) return std::numeric_limits<double>::quiet_NaN();
    return std::nullopt;
}

std::optional<double> plain_number(std::string_view text)
{
    const auto value = number(text);
    return value ? value : missing_number(text);
}

}  // namespace

void split_cells(std::string_view line, char delimiter, std::vector<std::string_view>& cells)
{
    cells.clear();
    const bool quotes = line.find('"') != std::string_view::npos;
    if (!quotes && delimiter != ' ') {
        split_plain(line, delimiter, cells);
        return;
    }
    const std::string_view marks = delimiter == ' ' ? std::string_view(" \t") : std::string_view(&delimiter, 1);
    std::size_t begin = 0;
    while (begin <= line.size()) {
        if (delimiter == ' ') begin = std::min(line.find_first_not_of(marks, begin), line.size());
        if (delimiter == ' ' && begin == line.size()) return;
        std::size_t end = begin;
        const std::size_t first = quotes ? line.find_first_not_of(" \t", begin) : std::string_view::npos;
        if (first != std::string_view::npos && line[first] == '"') end = std::min(line.find('"', first + 1), line.size() - 1);
        end = std::min(delimiter == ' ' ? line.find_first_of(marks, end) : line.find(delimiter, end), line.size());
        const std::string_view cell = line.substr(begin, end - begin);
        cells.push_back(quotes ? unquoted(cell) : trimmed(cell));
        begin = end + 1;
    }
}

Points points_of(std::string_view cell)
{
    if (cell.starts_with('-') || cell.starts_with('+')) cell.remove_prefix(1);
    if (cell.empty() || cell.find_first_not_of("0123456789.,") != std::string_view::npos) return Points::none;
    const std::size_t comma = cell.find(',');
    const std::string_view whole = cell.substr(0, comma);
    const std::size_t first = whole.find('.');
    if (first == std::string_view::npos) return Points::none;
    const bool grouped = first > 0 && first <= 3 && whole.front() != '0' && (whole.size() - first) % 4 == 0;
    if (!grouped) return Points::decimal;
    for (std::size_t i = first; i < whole.size(); ++i)
        if (((i - first) % 4 == 0) != (whole[i] == '.')) return Points::decimal;
    return comma != std::string_view::npos || whole.size() - first > 4 ? Points::thousands : Points::either;
}

std::optional<double> cell_number(std::string_view cell, const Dialect& dialect)
{
    if (!dialect.decimal_comma || cell.find_first_of(",.") == std::string_view::npos) return plain_number(cell);
    std::array<char, 64> copy;
    const auto text = with_point(cell, dialect, copy);
    return text ? plain_number(*text) : std::nullopt;
}

bool is_iso_time(std::string_view cell)
{
    return iso_time_ns(cell).has_value() || is_time_of_day(cell);
}

bool is_time_of_day(std::string_view cell)
{
    return time_of_day_ns(cell).has_value();
}

std::optional<std::int64_t> cell_time_ns(std::string_view cell, std::int64_t unit_ns, const Dialect& dialect)
{
    std::array<char, 64> copy;
    if (dialect.decimal_comma && cell.find_first_of(",.") != std::string_view::npos && cell.find(':') == std::string_view::npos) {
        const auto text = with_point(cell, dialect, copy);
        if (!text) return std::nullopt;
        cell = *text;
    }
    if (const auto exact = decimal_ns(cell, unit_ns)) return exact;
    if (const auto iso = iso_time_ns(cell)) return iso;
    if (const auto of_day = time_of_day_ns(cell)) return of_day;
    const auto value = number(cell);
    return value ? log_time_ns(*value, static_cast<double>(unit_ns)) : std::nullopt;
}

}  // namespace quorient::recording::csv
