#include "line_source.hpp"

#include <algorithm>
#include <array>
#include <charconv>

namespace quorient::recording {
namespace {

/// "-12.250", as most cells of most tables are. A double holds the digits and the power of ten exactly, so their quotient is rounded as
/// from_chars rounds, with less work. @returns nothing for any other number.
std::optional<double> short_decimal(std::string_view cell)
{
    constexpr std::size_t most_digits = 15;
    constexpr std::array<double, most_digits + 1> power_of_ten{1e0, 1e1, 1e2, 1e3, 1e4, 1e5, 1e6, 1e7, 1e8, 1e9, 1e10, 1e11, 1e12, 1e13, 1e14, 1e15};
    const bool negative = cell.starts_with('-');
    if (negative) cell.remove_prefix(1);
    if (cell.empty() || cell.size() > most_digits || cell.front() == '.' || cell.back() == '.') return std::nullopt;
    std::int64_t digits = 0;
    std::size_t point = cell.size() - 1;  // as if behind the last digit
    for (std::size_t i = 0; i < cell.size(); ++i) {
        const char c = cell[i];
        if (c >= '0' && c <= '9') digits = 10 * digits + (c - '0');
        else if (c == '.' && point == cell.size() - 1) point = i;
        else return std::nullopt;
    }
    const double size = static_cast<double>(digits) / power_of_ten[cell.size() - 1 - point];
    return negative ? -size : size;
}

}  // namespace

LineSource::Outcome LineSource::next(std::string_view& line)
{
    bool too_long = false;
    std::size_t searched = 0;
    for (;;) {
        const Bytes bytes = input_.peek(searched + 1);
        const std::string_view text(reinterpret_cast<const char*>(bytes.data()), bytes.size());
        const std::size_t length = text.find('\n', searched);
        const bool at_end = text.size() == searched;
        if (length == std::string_view::npos && !at_end) {
            searched = text.size();
            if (searched <= longest_line_) continue;
            too_long = true;
            input_.take(searched);
            searched = 0;
            continue;
        }
        if (at_end && searched == 0 && !too_long) return Outcome::end;
        line = text.substr(0, std::min(length, text.size()));
        input_.take(std::min(line.size() + 1, text.size()));
        break;
    }
    ++line_number_;
    if (line.ends_with('\r')) line.remove_suffix(1);
    return too_long || line.size() > longest_line_ ? Outcome::too_long : Outcome::line;
}

void LineSource::rewind()
{
    input_.rewind();
    line_number_ = 0;
}

std::string_view trimmed(std::string_view text)
{
    const auto is_blank = [](char c) { return c == ' ' || c == '\t'; };
    while (!text.empty() && is_blank(text.front())) text.remove_prefix(1);
    while (!text.empty() && is_blank(text.back())) text.remove_suffix(1);
    return text;
}

std::size_t split(std::string_view line, std::span<std::string_view> cells)
{
    std::size_t count = 0;
    const auto give = [&](std::string_view cell) {
        if (count < cells.size()) cells[count] = trimmed(cell);
        ++count;
    };
    if (line.find(',') != std::string_view::npos) {
        for (std::size_t begin = 0; begin <= line.size();) {
            const std::size_t end = std::min(line.find(',', begin), line.size());
            give(line.substr(begin, end - begin));
            begin = end + 1;
        }
        return count;
    }
    for (std::size_t begin = line.find_first_not_of(" \t"); begin != std::string_view::npos;) {
        const std::size_t end = std::min(line.find_first_of(" \t", begin), line.size());
        give(line.substr(begin, end - begin));
        begin = line.find_first_not_of(" \t", end);
    }
    return count;
}

std::optional<double> number(std::string_view cell)
{
    if (const auto value = short_decimal(cell)) return value;
    if (cell.starts_with('+')) cell.remove_prefix(1);
    double value = 0;
    const auto [end, error] = std::from_chars(cell.data(), cell.data() + cell.size(), value);
    if (cell.empty() || error != std::errc{} || end != cell.data() + cell.size()) return std::nullopt;
    return value;
}

}  // namespace quorient::recording
