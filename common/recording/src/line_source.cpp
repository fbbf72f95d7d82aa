#include "line_source.hpp"

#include <algorithm>
#include <charconv>

namespace quorient::recording {

bool LineSource::refill()
{
    std::copy(buffer_.begin() + static_cast<std::ptrdiff_t>(begin_), buffer_.begin() + static_cast<std::ptrdiff_t>(end_), buffer_.begin());
    end_ -= begin_;
    begin_ = 0;
    stream_.read(buffer_.data() + end_, static_cast<std::streamsize>(buffer_.size() - end_));
    const auto count = static_cast<std::size_t>(stream_.gcount());
    end_ += count;
    return count > 0;
}

std::optional<std::string_view> LineSource::take_line()
{
    const std::string_view rest(buffer_.data() + begin_, end_ - begin_);
    const std::size_t length = rest.find('\n');
    if (length == std::string_view::npos) return std::nullopt;
    begin_ += length + 1;
    return rest.substr(0, length);
}

LineSource::Outcome LineSource::next(std::string_view& line)
{
    bool too_long = false;
    std::optional<std::string_view> found;
    while (!(found = take_line())) {
        if (end_ - begin_ == buffer_.size()) {
            too_long = true;
            begin_ = end_;
        }
        if (!refill()) {
            if (begin_ == end_ && !too_long) return Outcome::end;
            found = std::string_view(buffer_.data() + begin_, end_ - begin_);
            begin_ = end_;
            break;
        }
    }
    ++line_number_;
    line = *found;
    if (line.ends_with('\r')) line.remove_suffix(1);
    return too_long || line.size() > longest_line ? Outcome::too_long : Outcome::line;
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
