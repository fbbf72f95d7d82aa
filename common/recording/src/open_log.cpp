#include "aligned_reader.hpp"
#include "formats.hpp"
#include "mcap/frame_reader.hpp"
#include "open_input.hpp"
#include "readers.hpp"

#include <fmt/format.h>

namespace quorient::recording {
namespace {

constexpr std::uint64_t sniffed_lines = 20;  // a DOT export may begin with lines about the device
constexpr std::size_t sniffed_records = 100;

using Error = tl::unexpected<std::string>;
using OpenedReader = tl::expected<std::unique_ptr<Reader>, std::string>;

/// The interval that most of the first records keep: the median of the steps forward.
std::optional<std::int64_t> usual_step_ns(LineSource& lines, std::size_t time_column, double unit_ns)
{
    std::vector<std::int64_t> steps_ns;
    std::optional<double> before;
    std::string_view line;
    while (steps_ns.size() < sniffed_records) {
        const auto outcome = lines.next(line);
        if (outcome == LineSource::Outcome::end) break;
        std::array<std::string_view, most_columns> cells;
        if (outcome == LineSource::Outcome::too_long || split(line, cells) <= time_column) continue;
        const auto stamp = number(cells[time_column]);
        if (!stamp) continue;
        if (before && *stamp > *before && (*stamp - *before) * unit_ns < 1e12)
            steps_ns.push_back(std::llround((*stamp - *before) * unit_ns));
        before = stamp;
    }
    if (steps_ns.empty()) return std::nullopt;
    const auto middle = steps_ns.begin() + static_cast<std::ptrdiff_t>(steps_ns.size() / 2);
    std::nth_element(steps_ns.begin(), middle, steps_ns.end());
    return std::max<std::int64_t>(1, *middle);
}

template <class TextLog, class Columns>
OpenedReader open_with(const std::filesystem::path& file, const tl::expected<Columns, std::string>& columns, double unit_ns, LineSource& lines)
{
    const std::uint64_t header_line = lines.line_number();
    if (!columns) return Error(fmt::format("{}:{}: {}", file.string(), header_line, columns.error()));
    const auto nominal_ns = usual_step_ns(lines, columns->time, unit_ns);
    if (!nominal_ns)
        return Error(fmt::format("{}:{}: no two of the records that follow have times one after the other", file.string(), header_line));
    auto input = open_input(file);
    if (!input) return Error(input.error());
    return std::make_unique<TextLog>(std::move(*input), file, *columns, header_line, *nominal_ns);
}

OpenedReader open_text(const std::filesystem::path& file, Input input, const LogOptions& options, std::vector<std::string>& remarks)
{
    if (options.any()) return open_aligned(file, options, remarks);
    LineSource lines(std::move(input));
    std::string_view line;
    for (std::uint64_t i = 0; i < sniffed_lines && lines.next(line) == LineSource::Outcome::line; ++i) {
        std::array<std::string_view, most_columns> cells;
        const std::span<const std::string_view> header(cells.data(), std::min(split(line, cells), cells.size()));
        if (const auto columns = csv_columns(header)) return open_with<CsvReader>(file, *columns, 1e9, lines);
        if (const auto columns = dot_columns(header))
            return open_with<DotReader>(file, *columns, *columns ? (*columns)->time_unit_ns : 1.0, lines);
    }
    return open_aligned(file, options, remarks);
}

}  // namespace

OpenedReader open_log(const std::filesystem::path& file)
{
    std::vector<std::string> remarks;
    return open_log(file, {}, remarks);
}

OpenedReader open_log(const std::filesystem::path& file, const LogOptions& options, std::vector<std::string>& remarks)
{
    if (std::filesystem::is_directory(file)) return open_aligned(file, options, remarks);
    auto input = open_input(file);
    if (!input) return Error(input.error());
    const Bytes bytes = input->peek(sniffed_bytes);
    const Kind kind = kind_of(bytes.first(std::min(sniffed_bytes, bytes.size())));
    if (options.any() && kind != Kind::text)
        return Error(fmt::format("{}: states its units itself; --unit, --time-unit and --lsb-per-deg-s are for tables", file.string()));
    if (kind == Kind::mimu4444) return std::make_unique<MimuReader>(std::move(*input), file.filename().string());
    if (kind == Kind::mcap) {
        if (auto frames = mcap::FrameReader::open(*input, file.filename().string())) return std::move(*frames);
    }
    if (kind == Kind::text) return open_text(file, std::move(*input), options, remarks);
    return open_aligned(file, options, remarks);
}

}  // namespace quorient::recording
