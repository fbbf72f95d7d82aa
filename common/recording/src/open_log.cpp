#include "readers.hpp"

#include <fmt/format.h>

namespace quorient::recording {
namespace {

constexpr std::size_t sniffed_bytes = 1U << 16U;
constexpr std::uint64_t header_lines = 20;  // a DOT export may begin with lines about the device
constexpr std::size_t sniffed_records = 100;

using Error = tl::unexpected<std::string>;
using Opened = tl::expected<std::unique_ptr<Reader>, std::string>;

std::vector<std::uint8_t> beginning_of(std::ifstream& stream)
{
    std::vector<std::uint8_t> bytes(sniffed_bytes);
    stream.read(reinterpret_cast<char*>(bytes.data()), static_cast<std::streamsize>(bytes.size()));
    bytes.resize(static_cast<std::size_t>(stream.gcount()));
    return bytes;
}

template <class Test>
bool any_packet(mimu::Bytes bytes, const Test& test)
{
    for (std::size_t at = 0; at + mimu::packet_size <= bytes.size(); ++at)
        if (test(bytes.subspan(at, mimu::packet_size))) return true;
    return false;
}

/// Whether the beginning holds packets whose fields, or whose 16-bit words, were written in the other byte order.
bool swapped(mimu::Bytes bytes)
{
    const auto little_endian = [](mimu::Bytes packet) {
        const std::uint16_t sum = mimu::checksum(packet);
        return mimu::starts_like_packet(packet) && packet[mimu::packet_size - 2] == (sum & 0xFFU) &&
               packet[mimu::packet_size - 1] == sum >> 8U;
    };
    if (any_packet(bytes, little_endian)) return true;
    std::vector<std::uint8_t> words(bytes.begin(), bytes.end());
    for (std::size_t at = 0; at + 1 < words.size(); at += 2) std::swap(words[at], words[at + 1]);
    return any_packet(words, mimu::intact);
}

bool looks_like_text(mimu::Bytes bytes)
{
    const auto control = [](std::uint8_t byte) { return byte < 0x20 && byte != '\t' && byte != '\n' && byte != '\r'; };
    return std::find(bytes.begin(), bytes.end(), '\n') != bytes.end() && std::none_of(bytes.begin(), bytes.end(), control);
}

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
Opened open_with(const std::filesystem::path& file, const tl::expected<Columns, std::string>& columns, double unit_ns, LineSource& lines)
{
    const std::uint64_t header_line = lines.line_number();
    if (!columns) return Error(fmt::format("{}:{}: {}", file.string(), header_line, columns.error()));
    const auto nominal_ns = usual_step_ns(lines, columns->time, unit_ns);
    if (!nominal_ns)
        return Error(fmt::format("{}:{}: no two of the records that follow have times one after the other", file.string(), header_line));
    return std::make_unique<TextLog>(file, *columns, header_line, *nominal_ns);
}

Opened open_text(const std::filesystem::path& file)
{
    LineSource lines(file);
    std::string_view line;
    for (std::uint64_t i = 0; i < header_lines && lines.next(line) == LineSource::Outcome::line; ++i) {
        std::array<std::string_view, most_columns> cells;
        const std::span<const std::string_view> header(cells.data(), std::min(split(line, cells), cells.size()));
        if (const auto columns = csv_columns(header)) return open_with<CsvReader>(file, *columns, 1e9, lines);
        if (const auto columns = dot_columns(header))
            return open_with<DotReader>(file, *columns, *columns ? (*columns)->time_unit_ns : 1.0, lines);
    }
    return Error(fmt::format(
        "{}:1: no header of a known log in the first {} lines; known are: time,increment_0,… (as quorient simulate writes it) and "
        "an Xsens DOT export (SampleTimeFine,…,Gyr_X,Gyr_Y,Gyr_Z)",
        file.string(), header_lines));
}

}  // namespace

Opened open_log(const std::filesystem::path& file)
{
    std::error_code error;
    if (!std::filesystem::is_regular_file(file, error))
        return Error(fmt::format("{}: {}", file.string(), error ? error.message() : "not a regular file"));
    std::ifstream stream(file, std::ios::binary);
    if (!stream) return Error(fmt::format("{}: cannot be opened for reading", file.string()));
    const auto bytes = beginning_of(stream);
    if (bytes.empty()) return Error(fmt::format("{}: byte 0: the file is empty", file.string()));
    if (any_packet(bytes, mimu::intact)) return std::make_unique<MimuReader>(file);
    if (looks_like_text(bytes)) return open_text(file);
    if (swapped(bytes))
        return Error(fmt::format("{}: byte 0: MIMU4444 packets in the wrong byte order; convert the file to big-endian", file.string()));
    return Error(fmt::format("{}: byte 0: neither text nor one intact MIMU4444 packet in the first {} bytes", file.string(), bytes.size()));
}

}  // namespace quorient::recording
