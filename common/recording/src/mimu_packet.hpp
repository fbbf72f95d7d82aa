#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

namespace quorient::recording::mimu {

// MIMU4444BT, 8 IMUs (format: README.md of this room). All fields are big-endian.
inline constexpr std::size_t packet_size = 106;
inline constexpr std::uint8_t packet_start = 0xAA;
inline constexpr std::uint8_t payload_size = 100;
inline constexpr std::array<std::uint8_t, 4> acknowledgement{0xA0, 0x28, 0x00, 0xC8};
inline constexpr double ticks_per_second = 64e6;
inline constexpr std::uint32_t nominal_ticks = 1'024'000;  // 62.5 Hz
inline constexpr std::size_t imus = 8;

using Bytes = std::span<const std::uint8_t>;

constexpr std::uint16_t u16(Bytes bytes, std::size_t at)
{
    return static_cast<std::uint16_t>(bytes[at] << 8U | bytes[at + 1]);
}

constexpr std::uint32_t u32(Bytes bytes, std::size_t at)
{
    return static_cast<std::uint32_t>(u16(bytes, at)) << 16U | u16(bytes, at + 2);
}

constexpr std::int16_t i16(Bytes bytes, std::size_t at)
{
    return static_cast<std::int16_t>(u16(bytes, at));
}

/// Sum of all bytes before the checksum, modulo 2^16.
constexpr std::uint16_t checksum(Bytes packet)
{
    std::uint16_t sum = 0;
    for (const std::uint8_t byte : packet.first(packet_size - 2)) sum = static_cast<std::uint16_t>(sum + byte);
    return sum;
}

constexpr bool starts_like_packet(Bytes bytes)
{
    return bytes[0] == packet_start && bytes[3] == payload_size;
}

constexpr bool intact(Bytes packet)
{
    return starts_like_packet(packet) && checksum(packet) == u16(packet, packet_size - 2);
}

constexpr std::uint16_t number(Bytes packet)
{
    return u16(packet, 1);
}
constexpr std::uint32_t ticks(Bytes packet)
{
    return u32(packet, 4);
}
constexpr std::int16_t acceleration(Bytes packet, std::size_t imu, std::size_t axis)
{
    return i16(packet, 8 + 12 * imu + 2 * axis);
}
constexpr std::int16_t rate(Bytes packet, std::size_t imu, std::size_t axis)
{
    return i16(packet, 14 + 12 * imu + 2 * axis);
}

}  // namespace quorient::recording::mimu
