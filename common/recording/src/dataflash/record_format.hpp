#pragma once

#include "bytes/byte_source.hpp"

#include <array>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace quorient::recording::dataflash {

inline constexpr std::array<std::uint8_t, 2> record_start{0xA3, 0x95};
inline constexpr std::size_t header_size = 3;  // record_start and the type
inline constexpr std::uint8_t format_type = 128;
inline constexpr std::size_t format_length = 89;

/// One field of a record: its letter says how it is stored.
struct Field {
    std::string name;
    char letter = 0;
    std::size_t offset = 0;  ///< from the record's first byte
    char unit = '-';         ///< id of the UNIT table
    char multiplier = '-';   ///< id of the MULT table
};

/// What an FMT record says of a type of records.
struct RecordFormat {
    std::uint8_t type = 0;
    std::size_t length = 0;  ///< header included
    std::string name;
    std::vector<Field> fields;

    std::optional<std::size_t> place(std::string_view field) const;

    /// Whether the fields fill the length: else nothing is read from such records but their end.
    bool consistent = false;
};

/// The format of FMT records themselves: the same in every log.
RecordFormat format_of_formats();

/// @param letters  e.g. "QffffffIIfBBHH"  @param labels  names, separated by commas
RecordFormat make_format(std::uint8_t type, std::size_t length, std::string_view name, std::string_view letters, std::string_view labels);

/// Bytes of a field with this letter; 0 = unknown letter.
std::size_t stored_size(char letter);

/// A number as the format means it (c, C, e, E in hundredths). 0 for texts and arrays.
double number_at(Bytes record, const Field& field);

/// A text without the zeros behind it.
std::string_view text_at(Bytes record, const Field& field);

/// An array field (letter a).
std::array<std::int16_t, 32> array_at(Bytes record, const Field& field);

/// The UNIT and MULT tables, with what ArduPilot writes where a log has none.
struct Units {
    std::map<char, std::string> label{{'E', "rad/s"}, {'k', "deg/s"}, {'r', "rad"}, {'d', "deg"}};
    std::map<char, double> multiplier;

    /// Factor to rad/s, or to rad. A field without a known unit is in rad/s, as ArduPilot's gyros are.
    double to_radians(const Field& field) const;
};

}  // namespace quorient::recording::dataflash
