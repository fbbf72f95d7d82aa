#pragma once

#include "bytes/byte_source.hpp"

#include <array>
#include <cstdint>
#include <optional>
#include <string>

namespace quorient::recording::mcap {

// The records of an MCAP file, version 0 [mcap.dev/spec]. All numbers are little-endian; a text is its u32 length and its bytes.
// A file is: magic, Header, data section (Schemas, Channels, Messages, Chunks with their MessageIndexes, …, DataEnd), summary section
// (copies of Schemas and Channels, ChunkIndexes, Statistics), SummaryOffsets, Footer, magic.

inline constexpr std::array<std::uint8_t, 8> magic{0x89, 'M', 'C', 'A', 'P', 0x30, '\r', '\n'};

enum class Opcode : std::uint8_t {
    header = 0x01,
    footer = 0x02,
    schema = 0x03,
    channel = 0x04,
    message = 0x05,
    chunk = 0x06,
    message_index = 0x07,
    chunk_index = 0x08,
    attachment = 0x09,
    attachment_index = 0x0A,
    statistics = 0x0B,
    metadata = 0x0C,
    metadata_index = 0x0D,
    summary_offset = 0x0E,
    data_end = 0x0F,
};

/// What stands before each record's content: u8 opcode, u64 length.
inline constexpr std::size_t record_header_size = 9;

struct Schema {
    std::uint16_t id = 0;  ///< 0 is no schema
    std::string name;      ///< "sensor_msgs/msg/Imu"
};

struct Channel {
    std::uint16_t id = 0;
    std::uint16_t schema_id = 0;
    std::string topic;
    std::string message_encoding;  ///< "cdr", "ros1"
};

/// The data is the rest of the record.
struct Message {
    std::uint16_t channel_id = 0;
    std::uint64_t log_time_ns = 0;
    Bytes data;
};

/// Records, compressed as one. They are the rest of the record.
struct Chunk {
    std::uint64_t uncompressed_size = 0;
    std::uint32_t uncompressed_crc = 0;  ///< 0 = not stated
    std::string compression;             ///< "", "zstd", "lz4"
    std::uint64_t records_size = 0;      ///< as they are stored
};

// The content of a record; nothing if it is cut or contradicts itself.
std::optional<Schema> parse_schema(Bytes content);
std::optional<Channel> parse_channel(Bytes content);
std::optional<Message> parse_message(Bytes content);

/// The fields before the records. @param content  the record's first bytes, at least chunk_fields_size() of them
std::optional<Chunk> parse_chunk_fields(Bytes content);

/// Bytes of a chunk's fields before its records.
std::size_t chunk_fields_size(const Chunk& chunk);

/// Longest name of a compression that a reader looks for.
inline constexpr std::size_t longest_compression = 32;

/// CRC-32 as in ISO 3309 and zlib.
std::uint32_t crc32(Bytes bytes);

}  // namespace quorient::recording::mcap
