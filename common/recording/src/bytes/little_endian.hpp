#pragma once

#include "byte_source.hpp"

#include <bit>
#include <cstring>

namespace quorient::recording {

/// A number stored with its lowest byte first, as all formats here do but where they say otherwise. The caller has checked the size.
template <class Number>
Number little_endian(Bytes bytes, std::size_t at = 0)
{
    static_assert(std::endian::native == std::endian::little, "this machine's numbers are stored as the logs' are");
    Number value;
    std::memcpy(&value, bytes.data() + at, sizeof value);
    return value;
}

}  // namespace quorient::recording
