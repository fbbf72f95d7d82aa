#pragma once

#include "bytes/byte_source.hpp"

#include <array>
#include <cstring>
#include <optional>
#include <type_traits>

namespace quorient::recording::mcap {

/// What precedes a sample in CDR: plain, little-endian.
inline constexpr std::array<std::uint8_t, 4> cdr_little_endian{0, 1, 0, 0};

/// A sample of the wire contract from its CDR. The contract's types have a fixed size and no hidden padding, so that what follows the four bytes
/// in front is the memory image of the plain struct. @returns nothing for another byte order or size
template <class Sample>
std::optional<Sample> sample_of(Bytes cdr)
{
    static_assert(std::is_trivially_copyable_v<Sample>);
    if (cdr.size() != cdr_little_endian.size() + sizeof(Sample)) return std::nullopt;
    if (cdr[0] != cdr_little_endian[0] || cdr[1] != cdr_little_endian[1]) return std::nullopt;
    Sample sample;
    std::memcpy(&sample, cdr.data() + cdr_little_endian.size(), sizeof sample);
    return sample;
}

}  // namespace quorient::recording::mcap
