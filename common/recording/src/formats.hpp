#pragma once

#include "bytes/byte_source.hpp"

#include <string>

namespace quorient::recording {

/// The kinds of files that the first bytes distinguish.
enum class Kind {
    empty,
    mimu4444,
    mimu4444_swapped,  ///< its packets, or 16-bit words, in the other byte order
    dataflash,
    dataflash_text,
    ulog,
    mcap,
    sqlite,
    text,
    blackbox,
    ros1_bag,
    tlog,
    archive,
    utf16,
    unknown,
};

/// How many bytes of a file's beginning kind_of() wants.
inline constexpr std::size_t sniffed_bytes = 1U << 16U;

Kind kind_of(Bytes beginning);

/// Why a file of this kind cannot be read, and what to do; for kinds without a reader.
std::string why_not(Kind kind, std::size_t sniffed);

}  // namespace quorient::recording
