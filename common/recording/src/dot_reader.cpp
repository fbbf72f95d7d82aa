#include "readers.hpp"

#include "quorient/messages/name.hpp"

#include <fmt/format.h>
#include <cmath>

namespace quorient::recording {
namespace {

constexpr double dot_range_rad_s = 2000.0 * degree;            // Xsens DOT user manual
constexpr std::int64_t fine_time_wrap_ns = 4'294'967'296'000;  // SampleTimeFine is a 32-bit count of microseconds

/// The name of the sensor in the file's name: "Xsens DOT7_D422….csv" -> "DOT7", "IMU_2.csv" -> "IMU_2".
std::string sensor_name(const std::filesystem::path& file)
{
    const std::string stem = file.stem().string();
    const std::size_t begin = stem.find("DOT");
    return begin == std::string::npos ? stem : stem.substr(begin, stem.find('_', begin) - begin);
}

std::optional<std::array<std::size_t, 3>> three_columns(std::span<const std::string_view> header, std::string_view name)
{
    std::array<std::size_t, 3> columns{};
    for (std::size_t k = 0; k < 3; ++k) {
        const auto found = column(header, fmt::format("{}_{}", name, "XYZ"[k]));
        if (!found) return std::nullopt;
        columns[k] = *found;
    }
    return columns;
}

}  // namespace

std::optional<tl::expected<DotColumns, std::string>> dot_columns(std::span<const std::string_view> header)
{
    const auto fine = column(header, "SampleTimeFine");
    const auto seconds = column(header, "time");
    if (!fine && !(seconds && column(header, "Euler_X"))) return std::nullopt;
    const auto rate = three_columns(header, "Gyr");
    if (!rate) return tl::unexpected(std::string("the header must name Gyr_X, Gyr_Y and Gyr_Z"));

    DotColumns columns;
    columns.time = fine ? *fine : *seconds;
    columns.time_unit_ns = fine ? 1e3 : 1e9;
    columns.time_wrap_ns = fine ? fine_time_wrap_ns : 0;
    columns.rate = *rate;
    columns.acceleration = three_columns(header, "Acc");
    columns.needed = std::max(columns.time, *std::max_element(rate->begin(), rate->end())) + 1;
    if (columns.acceleration)
        columns.needed = std::max(columns.needed, *std::max_element(columns.acceleration->begin(), columns.acceleration->end()) + 1);
    return columns;
}

DotReader::DotReader(Input input, const std::filesystem::path& file, const DotColumns& columns, std::uint64_t header_line, std::int64_t nominal_ns)
    : TextReader(std::move(input), file, header_line, columns.needed, nominal_ns), columns_(columns)
{
    description_.axis_count = 3;
    description_.instrument_count = 1;
    for (std::size_t k = 0; k < 3; ++k) {
        description_.axis[k][k] = 1.0;
        description_.range[k] = dot_range_rad_s;
    }
    copy_text(sensor_name(file), description_.instrument_name[0]);
    copy_text(sensor_name(file), description_.name);
}

std::optional<ReadOutcome> DotReader::read(Cells cells, RecordedFrame& frame)
{
    const auto stamp_ns = stamp(cells[columns_.time], columns_.time_unit_ns);
    if (!stamp_ns) return refuse_cell(cells[columns_.time]);
    const auto before = std::exchange(stamp_ns_, stamp_ns);
    if (!before) return std::nullopt;  // an increment needs an interval: the first record only sets the clock (a DOT sends zeros in it)

    std::int64_t step_ns = *stamp_ns - *before;
    if (step_ns < -columns_.time_wrap_ns / 2) step_ns += columns_.time_wrap_ns;
    const auto step = clock_.advance(step_ns);
    statistics_.duration_ns = clock_.elapsed_ns();

    const double interval_s = static_cast<double>(step_ns) * 1e-9;
    const auto finite = read_values(cells, interval_s, frame);
    if (!finite) return ReadOutcome::rejected;
    if (!*finite) return refuse(statistics_.nan, "a value is not finite");
    if (step == LogClock::Step::repeated) return refuse(statistics_.repeated, "the time stamp of the line before again");
    // A gap is refused too: the sample after a doubled step may be the one that was due in between, stamped late (DOT7, line 3908).
    if (step != LogClock::Step::regular) return refuse_step(step_ns);

    frame.valid_mask = all_axes(3);
    frame.acceleration_mask = columns_.acceleration ? all_axes(3) : 0;
    frame.truth.reset();
    return give(frame, clock_.elapsed_ns(), interval_s, 3);
}

/// @returns whether all values are finite; nothing if a cell is no number (already refused).
std::optional<bool> DotReader::read_values(Cells cells, double interval_s, RecordedFrame& frame)
{
    bool finite = true;
    const auto read_cell = [&](std::size_t place, double unit, double& value) {
        const auto read = number(cells[place]);
        if (!read) refuse_cell(cells[place]);
        finite = finite && read && std::isfinite(*read);
        value = read.value_or(0.0) * unit;
        return read.has_value();
    };
    for (std::size_t k = 0; k < 3; ++k) {
        if (!read_cell(columns_.rate[k], degree * interval_s, frame.increment[k])) return std::nullopt;
        if (columns_.acceleration && !read_cell((*columns_.acceleration)[k], 1.0, frame.acceleration_m_s2[k])) return std::nullopt;
    }
    return finite;
}

}  // namespace quorient::recording
