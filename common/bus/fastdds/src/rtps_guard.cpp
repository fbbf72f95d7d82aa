#include "rtps_guard.hpp"

#include <cstring>

namespace quorient::bus::fastdds {

namespace {

constexpr std::size_t header_size = 20;
constexpr std::size_t submessage_header_size = 4;
constexpr std::uint8_t little_endian_flag = 0x01;
constexpr std::uint8_t inline_qos_flag = 0x02;
constexpr std::uint8_t pad = 0x01;
constexpr std::uint8_t gap = 0x08;
constexpr std::uint8_t info_timestamp = 0x09;
constexpr std::uint8_t data = 0x15;
constexpr std::uint8_t data_fragment = 0x16;
constexpr std::uint16_t sentinel = 0x0001;
constexpr std::uint8_t statistics = 0x80;
constexpr std::size_t statistics_size = 56;

/// A gap is walked number by number, and numbers that are not the next expected are kept one by one. Writers here keep far fewer samples.
constexpr std::int64_t longest_gap = 65'536;

/// Memory for the whole sample is taken on its first fragment. Samples here are far smaller.
constexpr std::uint32_t largest_sample = 1'048'576;

/// The content of one submessage, behind its header.
class Submessage {
public:
    Submessage(const std::uint8_t* content, std::size_t size, bool little) : content_(content), size_(size), little_(little) {}

    std::size_t size() const { return size_; }

    std::uint16_t half_word(std::size_t place) const { return static_cast<std::uint16_t>(number(place, 2)); }
    std::uint32_t word(std::size_t place) const { return number(place, 4); }

    /// [RTPS 9.3.2.3]: the high word comes first in either byte order.
    std::int64_t sequence_number(std::size_t place) const
    {
        return static_cast<std::int64_t>(static_cast<std::uint64_t>(word(place)) << 32U | word(place + 4));
    }

private:
    std::uint32_t number(std::size_t place, std::size_t bytes) const
    {
        std::uint32_t value = 0;
        for (std::size_t i = 0; i < bytes; ++i) value = value << 8U | content_[place + (little_ ? bytes - 1 - i : i)];
        return value;
    }

    const std::uint8_t* content_;
    std::size_t size_;
    bool little_;
};

/// [RTPS 9.4.5.6]: reader, writer, first number, and behind the gap the base of a set.
bool is_sound_gap(const Submessage& content)
{
    if (content.size() < 28) return false;
    const std::int64_t first = content.sequence_number(8);
    const std::int64_t end = content.sequence_number(16);
    return first > 0 && end >= first && end - first <= longest_gap;
}

/// Whether the list of parameters that begins there [RTPS 9.4.2.11] ends in the same submessage.
bool ends(const Submessage& content, std::size_t place)
{
    while (place + 4 <= content.size()) {
        const std::size_t length = content.half_word(place + 2);
        if (content.half_word(place) == sentinel) return true;
        place += 4 + length;
    }
    return false;
}

/// [RTPS 9.4.5.4, 9.4.5.5]: flags, how far it is from here to the inline QoS, reader, writer, number.
bool is_sound_data(const Submessage& content, std::uint8_t flags)
{
    if (content.size() < 20) return false;
    return (flags & inline_qos_flag) == 0 || ends(content, 4U + content.half_word(2));
}

/// [RTPS 9.4.5.5]: flags, reader, writer, number, and which fragments of what size of a sample of what size.
bool is_sound_fragment(const Submessage& content)
{
    return content.size() >= 32 && content.word(28) <= largest_sample;
}

}  // namespace

bool is_sound_rtps(const std::uint8_t* bytes, std::size_t size)
{
    if (size < header_size || std::memcmp(bytes, "RTPS", 4) != 0) return false;
    for (std::size_t place = header_size; place < size;) {
        if (size - place < submessage_header_size) return false;
        const auto id = bytes[place];
        const std::uint8_t flags = bytes[place + 1];
        const bool little = (flags & little_endian_flag) != 0;
        const std::size_t first = bytes[place + 2], second = bytes[place + 3];
        std::size_t length = little ? first | second << 8U : first << 8U | second;
        const std::size_t left = size - place - submessage_header_size;
        if (length > left) return false;
        if (id == statistics) return length == statistics_size && length == left;
        // Of the others, a length of 0 reaches to the datagram's end.
        if (length == 0 && id != pad && id != info_timestamp) length = left;
        const Submessage content(bytes + place + submessage_header_size, length, little);
        if (id == gap && !is_sound_gap(content)) return false;
        if ((id == data || id == data_fragment) && !is_sound_data(content, flags)) return false;
        if (id == data_fragment && !is_sound_fragment(content)) return false;
        place += submessage_header_size + length;
    }
    return true;
}

}  // namespace quorient::bus::fastdds
