#include "line_source.hpp"

#include <algorithm>
#include <charconv>

namespace quorient::recording {

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
    constexpr std::string_view blanks = " \t";
    const std::size_t first = text.find_first_not_of(blanks);
    if (first == std::string_view::npos) return {};
    return text.substr(first, text.find_last_not_of(blanks) - first + 1);
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
    if (cell.starts_with('+')) cell.remove_prefix(1);
    double value = 0;
    const auto [end, error] = std::from_chars(cell.data(), cell.data() + cell.size(), value);
    if (cell.empty() || error != std::errc{} || end != cell.data() + cell.size()) return std::nullopt;
    return value;
}

}  // namespace quorient::recording
