#include "rtps_guard.hpp"

#include <cstring>

namespace quorient::bus::fastdds {

namespace {

constexpr std::size_t header_size = 20;
constexpr std::size_t submessage_header_size = 4;
constexpr std::uint8_t little_endian_flag = 0x01;
constexpr std::uint8_t pad = 0x01;
constexpr std::uint8_t info_timestamp = 0x09;
constexpr std::uint8_t statistics = 0x80;
constexpr std::size_t statistics_size = 56;

}  // namespace

bool is_sound_rtps(const std::uint8_t* data, std::size_t size)
{
    if (size < header_size || std::memcmp(data, "RTPS", 4) != 0) return false;
    for (std::size_t place = header_size; place < size;) {
        if (size - place < submessage_header_size) return false;
        const auto id = data[place];
        const bool little = (data[place + 1] & little_endian_flag) != 0;
        const std::size_t first = data[place + 2], second = data[place + 3];
        const std::size_t length = little ? first | second << 8U : first << 8U | second;
        const std::size_t left = size - place - submessage_header_size;
        if (length > left) return false;
        if (id == statistics) return length == statistics_size && length == left;
        // Of the others, a length of 0 reaches to the datagram's end.
        if (length == 0 && id != pad && id != info_timestamp) return true;
        place += submessage_header_size + length;
    }
    return true;
}

}  // namespace quorient::bus::fastdds
