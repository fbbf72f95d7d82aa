#include "readers.hpp"

#include "quorient/messages/name.hpp"

#include <fmt/format.h>
#include <cmath>

namespace quorient::recording {

std::optional<tl::expected<CsvColumns, std::string>> csv_columns(std::span<const std::string_view> header)
{
    if (!column(header, "increment_0")) return std::nullopt;
    const auto time = column(header, "time");
    if (!time) return tl::unexpected(std::string("the header has no column time"));

    CsvColumns columns;
    columns.time = *time;
    columns.needed = columns.time + 1;
    while (const auto increment = column(header, fmt::format("increment_{}", columns.increment.size()))) {
        if (columns.increment.size() == max_axes) return tl::unexpected(fmt::format("more than {} axes", max_axes));
        columns.increment.push_back(*increment);
        columns.needed = std::max(columns.needed, *increment + 1);
    }
    constexpr std::array<std::string_view, 4> names{"truth_w", "truth_x", "truth_y", "truth_z"};
    std::array<std::size_t, 4> truth{};
    std::size_t found = 0;
    for (std::size_t i = 0; i < names.size(); ++i) {
        const auto place = column(header, names[i]);
        if (!place) continue;
        ++found;
        truth[i] = *place;
        columns.needed = std::max(columns.needed, *place + 1);
    }
    if (found == names.size()) columns.truth = truth;
    if (found != 0 && !columns.truth) return tl::unexpected(std::string("the truth needs all of truth_w, truth_x, truth_y, truth_z"));
    return columns;
}

CsvReader::CsvReader(Input input, const std::filesystem::path& file, const CsvColumns& columns, std::uint64_t header_line, std::int64_t nominal_ns)
    : TextReader(std::move(input), file, header_line, columns.needed, nominal_ns), columns_(columns)
{
    const auto axes = static_cast<std::uint8_t>(columns_.increment.size());
    description_.axis_count = description_.instrument_count = axes;
    for (std::uint8_t axis = 0; axis < axes; ++axis) description_.instrument[axis] = axis;
    copy_text(file.stem().string(), description_.name);
}

std::optional<ReadOutcome> CsvReader::read(Cells cells, RecordedFrame& frame)
{
    const auto stamp_ns = stamp(cells[columns_.time], 1e9);
    if (!stamp_ns) return refuse_cell(cells[columns_.time]);
    const auto before = std::exchange(stamp_ns_, stamp_ns);

    std::int64_t step_ns = clock_.nominal_ns();  // the first record stands for one nominal interval: it has no step to judge
    std::uint64_t missing = 0;
    if (before) {
        step_ns = *stamp_ns - *before;
        const auto step = clock_.advance(step_ns);
        statistics_.duration_ns = clock_.elapsed_ns();
        if (step == LogClock::Step::repeated) return refuse(statistics_.repeated, "the time of the line before again");
        if (step == LogClock::Step::irregular) return refuse_step(step_ns);
        missing = clock_.missing();
    }
    if (const auto refused = refuse_values(cells, frame)) return refused;

    statistics_.lost += missing;
    if (frame.valid_mask != all_axes(columns_.increment.size())) ++statistics_.incomplete;
    frame.acceleration_mask = 0;
    const double interval_s = static_cast<double>(step_ns) * 1e-9 / static_cast<double>(missing + 1);
    return give(frame, clock_.elapsed_ns() + clock_.nominal_ns(), interval_s, columns_.increment.size());
}

/// Fills increments, validity and truth, unless they are to be refused. An axis without a sample reads nan.
std::optional<ReadOutcome> CsvReader::refuse_values(Cells cells, RecordedFrame& frame)
{
    frame.valid_mask = 0;
    for (std::size_t axis = 0; axis < columns_.increment.size(); ++axis) {
        const std::string_view cell = cells[columns_.increment[axis]];
        const auto increment = number(cell);
        if (!increment) return refuse_cell(cell);
        frame.increment[axis] = std::isfinite(*increment) ? *increment : 0.0;
        if (std::isfinite(*increment)) frame.valid_mask |= axis_bit(axis);
    }
    if (frame.valid_mask == 0) return refuse(statistics_.nan, "no axis has a finite value");

    frame.truth.reset();
    if (!columns_.truth) return std::nullopt;
    auto& truth = frame.truth.emplace();
    for (std::size_t i = 0; i < truth.size(); ++i) {
        const std::string_view cell = cells[(*columns_.truth)[i]];
        const auto component = number(cell);
        if (!component) return refuse_cell(cell);
        if (!std::isfinite(*component)) return refuse(statistics_.nan, "the truth is not finite");
        truth[i] = *component;
    }
    return std::nullopt;
}

}  // namespace quorient::recording
