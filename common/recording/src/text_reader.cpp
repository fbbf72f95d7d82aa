#include "readers.hpp"
#include "quorient/messages/meaning.hpp"

#include <fmt/format.h>
#include <cmath>

namespace quorient::recording {
namespace {

constexpr std::size_t longest_line = 4096;

}  // namespace

TextReader::TextReader(Input input, const std::filesystem::path& file, std::uint64_t header_line, std::size_t needed_cells,
                       std::int64_t nominal_ns)
    : clock_(nominal_ns), lines_(std::move(input), longest_line), file_(file.filename().string()), needed_cells_(needed_cells)
{
    std::string_view line;
    while (lines_.line_number() < header_line && lines_.next(line) != LineSource::Outcome::end) {
    }
    description_.kind = octet(SensorKind::gyro);
    description_.interval_s = static_cast<double>(nominal_ns) * 1e-9;
}

ReadOutcome TextReader::next(RecordedFrame& frame)
{
    while (true) {
        std::string_view line;
        const auto found = lines_.next(line);
        if (found == LineSource::Outcome::end) return end_of_text();
        if (found == LineSource::Outcome::line && (trimmed(line).empty() || trimmed(line).starts_with('#'))) continue;

        ++statistics_.records;
        if (found == LineSource::Outcome::too_long) return refuse(statistics_.malformed, "the line is too long");
        std::array<std::string_view, most_columns> cells;
        const std::size_t count = std::min(split(line, cells), cells.size());
        if (count < needed_cells_)
            return refuse(statistics_.malformed, fmt::format("{} cells, at least {} are needed", count, needed_cells_));

        const auto outcome = read(std::span(cells).first(count), frame);
        if (outcome) return *outcome;
    }
}

ReadOutcome TextReader::end_of_text()
{
    if (ended_ || lines_.trouble().empty()) return ReadOutcome::end;
    ended_ = true;
    ++statistics_.records;
    return refuse(statistics_.malformed, lines_.trouble());
}

ReadOutcome TextReader::refuse(std::uint64_t& reason, std::string_view why)
{
    ++reason;
    problem_ = fmt::format("{}:{}: {}", file_, lines_.line_number(), why);
    return ReadOutcome::rejected;
}

ReadOutcome TextReader::refuse_cell(std::string_view cell)
{
    return refuse(statistics_.malformed, fmt::format("'{}' is not a number", cell.substr(0, 40)));
}

ReadOutcome TextReader::refuse_step(std::int64_t step_ns)
{
    return refuse(statistics_.irregular, fmt::format("a time step of {:.6f} s where {:.6f} s is the rule",
                                                     static_cast<double>(step_ns) * 1e-9, description_.interval_s));
}

ReadOutcome TextReader::give(RecordedFrame& frame, std::int64_t time_ns, double interval_s, std::size_t axis_count)
{
    frame.time_ns = time_ns;
    frame.interval_s = interval_s;
    frame.lost_before = clock_.intervals(time_ns - last_frame_ns_) - 1;
    frame.position = lines_.line_number();
    frame.axis_count = axis_count;
    last_frame_ns_ = time_ns;
    ++statistics_.frames;
    return ReadOutcome::frame;
}

std::optional<std::int64_t> TextReader::stamp(std::string_view cell, double unit_ns)
{
    constexpr double longest_ns = 4e18;  // what 63 bits hold
    const auto value = number(cell);
    if (!value || !(std::abs(*value * unit_ns) < longest_ns)) return std::nullopt;
    return std::llround(*value * unit_ns);
}

std::optional<std::size_t> column(std::span<const std::string_view> header, std::string_view name)
{
    const auto found = std::find(header.begin(), header.end(), name);
    if (found == header.end()) return std::nullopt;
    return static_cast<std::size_t>(found - header.begin());
}

}  // namespace quorient::recording
