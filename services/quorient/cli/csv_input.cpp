#include "csv_input.hpp"

#include <fmt/format.h>
#include <algorithm>
#include <charconv>
#include <cmath>
#include <iostream>
#include <utility>

namespace quorient::cli {

namespace {

constexpr std::string_view white_space = " \t\r\v\f";

enum class Parse { number, not_a_number, out_of_range };

Parse parse(std::string_view text, double& value)
{
    if (text.starts_with('+') && !text.starts_with("+-")) text.remove_prefix(1);
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    if (end != text.data() + text.size()) return Parse::not_a_number;
    if (error == std::errc::result_out_of_range) return Parse::out_of_range;
    return error == std::errc{} ? Parse::number : Parse::not_a_number;
}

}  // namespace

tl::expected<CsvReader, std::string> CsvReader::open(const std::string& path, CsvOptions options)
{
    if (path == "-") return CsvReader(std::cin, "stdin", options);
    auto file = std::make_unique<std::ifstream>(path);
    if (!*file) return tl::unexpected(fmt::format("{}: cannot be opened; check the path and its permissions", path));
    return CsvReader(std::move(file), path, options);
}

CsvReader::CsvReader(std::istream& input, std::string name, CsvOptions options) : input_(&input), name_(std::move(name)), options_(options)
{
}

CsvReader::CsvReader(std::unique_ptr<std::ifstream> file, std::string name, CsvOptions options)
    : file_(std::move(file)), input_(file_.get()), name_(std::move(name)), options_(options)
{
}

std::string CsvReader::at(std::size_t line, std::size_t column, std::string_view what) const
{
    return column == 0 ? fmt::format("{}:{}: {}", name_, line, what) : fmt::format("{}:{}:{}: {}", name_, line, column, what);
}

tl::expected<bool, std::string> CsvReader::next(CsvRow& row)
{
    while (std::getline(*input_, text_)) {
        ++line_;
        if (line_ == 1 && text_.starts_with("\xEF\xBB\xBF")) text_.erase(0, 3);  // byte-order mark
        if (auto done = split(std::string_view(text_).substr(0, text_.find('#'))); !done) return tl::unexpected(done.error());
        if (cells_.empty()) continue;
        if (std::exchange(expect_header_, false) && take_header()) continue;
        if (auto done = read_numbers(row); !done) return tl::unexpected(done.error());
        options_.columns = row.value.size();
        return true;
    }
    if (input_->bad()) return tl::unexpected(fmt::format("{}: cannot be read; is it a file?", name_));
    return false;
}

/// Between two cells stands white space, one comma, or both.
tl::expected<void, std::string> CsvReader::split(std::string_view text)
{
    cells_.clear();
    std::size_t place = 0;
    bool after_comma = false;
    while ((place = text.find_first_not_of(white_space, place)) != std::string_view::npos) {
        if (text[place] == ',') {
            if (after_comma || cells_.empty()) return tl::unexpected(at(line_, place + 1, "a value is missing before this comma"));
            after_comma = true;
            ++place;
            continue;
        }
        const std::size_t end = std::min(text.find_first_of(" \t\r\v\f,", place), text.size());
        cells_.push_back({text.substr(place, end - place), place + 1});
        after_comma = false;
        place = end;
    }
    if (after_comma) return tl::unexpected(at(line_, text.size() + 1, "a value is missing after the last comma"));
    return {};
}

std::string CsvReader::nothing() const
{
    const auto wanted = options_.columns ? fmt::format("a row of {} numbers", *options_.columns) : std::string("a row of numbers");
    const auto found = !header_.empty() ? fmt::format("only a header of {} names", header_.size())
                       : line_ > 0      ? fmt::format("only comments and blank lines ({})", line_)
                                        : std::string("nothing at all");
    return fmt::format("{}: expected {}, there is {}", name_, wanted, found);
}

bool CsvReader::take_header()
{
    double ignored = 0;
    const auto is_like_a_number = [&](const Cell& cell) {
        constexpr std::string_view beginnings = "0123456789+-.";
        return beginnings.find(cell.text.front()) != std::string_view::npos || parse(cell.text, ignored) != Parse::not_a_number;
    };
    if (std::ranges::any_of(cells_, is_like_a_number)) return false;
    for (const Cell& cell : cells_) header_.emplace_back(cell.text);
    return true;
}

tl::expected<void, std::string> CsvReader::read_numbers(CsvRow& row) const
{
    row.line = line_;
    row.value.clear();
    for (const Cell& cell : cells_) {
        double value = 0;
        switch (parse(cell.text, value)) {
            case Parse::not_a_number:
                return tl::unexpected(at(line_, cell.column, fmt::format("'{}' is not a number", cell.text)));
            case Parse::out_of_range:
                return tl::unexpected(at(line_, cell.column, fmt::format("'{}' does not fit a double", cell.text)));
            case Parse::number:
                break;
        }
        if (!std::isfinite(value) && !options_.allow_non_finite)
            return tl::unexpected(at(line_, cell.column, fmt::format("'{}' is not allowed here; a finite number is needed", cell.text)));
        row.value.push_back(value);
    }
    const std::size_t needed = options_.columns.value_or(row.value.size());
    if (row.value.size() == needed) return {};
    const std::size_t column = row.value.size() > needed ? cells_[needed].column : cells_.back().column + cells_.back().text.size();
    return tl::unexpected(at(line_, column, fmt::format("{} numbers needed in every row, got {}", needed, row.value.size())));
}

tl::expected<std::vector<CsvRow>, std::string> read_csv(const std::string& path, CsvOptions options)
{
    auto reader = CsvReader::open(path, options);
    if (!reader) return tl::unexpected(reader.error());
    std::vector<CsvRow> rows;
    for (CsvRow row;;) {
        const auto more = reader->next(row);
        if (!more) return tl::unexpected(more.error());
        if (!*more) return rows;
        rows.push_back(row);
    }
}

}  // namespace quorient::cli
