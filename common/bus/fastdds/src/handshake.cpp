#include "handshake.hpp"

#include "rtps_submessage.hpp"

#include <algorithm>
#include <array>
#include <span>

namespace quorient::bus::fastdds {

namespace {

constexpr std::uint8_t data_id = 0x15;
constexpr std::uint8_t fragment_id = 0x16;

/// Place in the content of either [RTPS 9.4.5.4]: behind flags, an offset and the reader.
constexpr std::size_t writer = 8;
constexpr std::array<std::uint8_t, 4> stateless_message_writer{0x00, 0x02, 0x01, 0xc3};

}  // namespace

bool is_handshake(const std::uint8_t* data, std::size_t size)
{
    for (std::size_t place = header_size; place + submessage_header_size <= size;) {
        const auto header = submessage_header_at(data + place);
        place += submessage_header_size;
        if (header.length > size - place) return false;
        const bool carries = header.id == data_id || header.id == fragment_id;
        if (carries && header.length >= writer + stateless_message_writer.size() &&
            std::ranges::equal(stateless_message_writer, std::span{data + place + writer, stateless_message_writer.size()}))
            return true;
        place += header.length;
    }
    return false;
}

std::chrono::nanoseconds HandshakePause::left() const
{
    return std::max(std::chrono::nanoseconds{last_ - now()} + length, std::chrono::nanoseconds{0});
}

}  // namespace quorient::bus::fastdds
