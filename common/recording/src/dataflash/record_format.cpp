#include "record_format.hpp"

#include "bytes/little_endian.hpp"
#include "quorient/recording/instrument_log.hpp"
#include "readers.hpp"

#include <algorithm>

namespace quorient::recording::dataflash {
namespace {

/// A 16-bit float [IEEE 754 binary16].
double half_at(Bytes bytes, std::size_t at)
{
    const auto bits = little_endian<std::uint16_t>(bytes, at);
    const int exponent = bits >> 10U & 0x1F;
    const double fraction = (bits & 0x3FFU) / 1024.0;
    const double sign = (bits & 0x8000U) != 0 ? -1 : 1;
    if (exponent == 0x1F) return fraction == 0 ? sign * std::numeric_limits<double>::infinity() : not_logged;
    return sign * (exponent == 0 ? std::ldexp(fraction, -14) : std::ldexp(1 + fraction, exponent - 15));
}

}  // namespace

std::optional<std::size_t> RecordFormat::place(std::string_view field) const
{
    const auto found = std::find_if(fields.begin(), fields.end(), [&](const Field& candidate) { return candidate.name == field; });
    if (found == fields.end()) return std::nullopt;
    return static_cast<std::size_t>(found - fields.begin());
}

std::size_t stored_size(char letter)
{
    switch (letter) {
        case 'b':
        case 'B':
        case 'M': return 1;
        case 'h':
        case 'H':
        case 'c':
        case 'C':
        case 'g': return 2;
        case 'i':
        case 'I':
        case 'f':
        case 'n':
        case 'e':
        case 'E':
        case 'L': return 4;
        case 'd':
        case 'q':
        case 'Q': return 8;
        case 'N': return 16;
        case 'Z':
        case 'a': return 64;
        default: return 0;
    }
}

RecordFormat make_format(std::uint8_t type, std::size_t length, std::string_view name, std::string_view letters, std::string_view labels)
{
    RecordFormat format{type, length, std::string(name), {}, false};
    std::size_t offset = header_size;
    bool known = true;
    for (const char letter : letters) {
        const std::size_t end = std::min(labels.find(','), labels.size());
        format.fields.push_back({std::string(trimmed(labels.substr(0, end))), letter, offset});
        labels.remove_prefix(std::min(labels.size(), end + 1));
        known = known && stored_size(letter) > 0;
        offset += stored_size(letter);
    }
    format.consistent = known && offset == length;
    return format;
}

RecordFormat format_of_formats()
{
    return make_format(format_type, format_length, "FMT", "BBnNZ", "Type,Length,Name,Format,Columns");
}

double number_at(Bytes record, const Field& field)
{
    const std::size_t at = field.offset;
    switch (field.letter) {
        case 'b': return static_cast<std::int8_t>(record[at]);
        case 'B':
        case 'M': return record[at];
        case 'h': return little_endian<std::int16_t>(record, at);
        case 'H': return little_endian<std::uint16_t>(record, at);
        case 'c': return little_endian<std::int16_t>(record, at) * 0.01;
        case 'C': return little_endian<std::uint16_t>(record, at) * 0.01;
        case 'g': return half_at(record, at);
        case 'i':
        case 'L': return little_endian<std::int32_t>(record, at);
        case 'I': return little_endian<std::uint32_t>(record, at);
        case 'e': return little_endian<std::int32_t>(record, at) * 0.01;
        case 'E': return little_endian<std::uint32_t>(record, at) * 0.01;
        case 'f': return little_endian<float>(record, at);
        case 'd': return little_endian<double>(record, at);
        case 'q': return static_cast<double>(little_endian<std::int64_t>(record, at));
        case 'Q': return static_cast<double>(little_endian<std::uint64_t>(record, at));
        default: return 0;
    }
}

std::string_view text_at(Bytes record, const Field& field)
{
    const std::string_view text(reinterpret_cast<const char*>(record.data()) + field.offset, stored_size(field.letter));
    return text.substr(0, std::min(text.find('\0'), text.size()));
}

std::array<std::int16_t, 32> array_at(Bytes record, const Field& field)
{
    std::array<std::int16_t, 32> values{};
    for (std::size_t i = 0; i < values.size(); ++i) values[i] = little_endian<std::int16_t>(record, field.offset + 2 * i);
    return values;
}

double Units::to_radians(const Field& field) const
{
    const auto unit = label.find(field.unit);
    const double factor = unit != label.end() && unit->second.starts_with("deg") ? degree : 1.0;
    const auto found = multiplier.find(field.multiplier);
    const bool scaled = found != multiplier.end() && found->second != 0;  // 0 stands for "no multiplier"
    return scaled ? factor * found->second : factor;
}

}  // namespace quorient::recording::dataflash
