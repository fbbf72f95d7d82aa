#pragma once

#include <cstddef>
#include <cstdint>

namespace quorient::bus::fastdds {

inline constexpr std::size_t header_size = 20;  ///< header of a datagram [RTPS 9.4.4]
inline constexpr std::size_t submessage_header_size = 4;

struct SubmessageHeader {
    std::uint8_t id;
    std::uint8_t flags;
    bool little;  ///< byte order of what follows
    std::size_t length;
};

/// [RTPS 9.4.5.1]: identifier, flags, octets to the next header. @param bytes  at least `submessage_header_size`
inline SubmessageHeader submessage_header_at(const std::uint8_t* bytes)
{
    constexpr std::uint8_t little_endian_flag = 0x01;
    const bool little = (bytes[1] & little_endian_flag) != 0;
    const std::size_t first = bytes[2], second = bytes[3];
    return {bytes[0], bytes[1], little, little ? first | second << 8U : first << 8U | second};
}

/// A length of 0 means "empty" for these, and "up to the datagram's end" for all others.
inline bool may_be_empty(std::uint8_t id)
{
    constexpr std::uint8_t pad = 0x01;
    constexpr std::uint8_t info_timestamp = 0x09;
    return id == pad || id == info_timestamp;
}

/// Whether this last octet of an entity's id belongs to an entity that describes participants and endpoints [RTPS 9.3.1.2].
inline bool is_builtin(std::uint8_t entity_kind)
{
    constexpr std::uint8_t builtin_entity = 0xc0;
    return (entity_kind & builtin_entity) == builtin_entity;
}

/// The content of one submessage, behind its header.
class Submessage {
public:
    Submessage(const std::uint8_t* content, std::size_t size, bool little) : content_(content), size_(size), little_(little) {}

    std::size_t size() const { return size_; }

    /// The same, its numbers in this byte order.
    Submessage in_order(bool little) const { return {content_, size_, little}; }

    std::uint8_t octet(std::size_t place) const { return content_[place]; }
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

}  // namespace quorient::bus::fastdds
