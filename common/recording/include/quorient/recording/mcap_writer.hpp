#pragma once

#include <cstdint>
#include <map>
#include <memory>
#include <ostream>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace quorient::recording::mcap {

/// Writes an MCAP file, version 0 [mcap.dev/spec]: schemas and channels first, then chunks of messages (zstd) with their indexes, at the end the
/// summary with statistics. Each chunk reaches the stream in one write. If the process dies, whatever chunks were written can be read; only the
/// summary is missing.
///
/// A stream that fails is the caller's to notice: after each call that writes, look at the stream. intact_size() then says how much of the file is whole.
class Writer {
public:
    /// @param library  the program's name, for the header
    Writer(std::ostream& out, std::string_view library);
    ~Writer();

    /// Both before the first message. Ids count from 1.
    std::uint16_t add_schema(std::string_view name, std::string_view encoding, std::string_view text);
    std::uint16_t add_channel(std::string_view topic, std::string_view message_encoding, std::uint16_t schema);

    /// Adds a message to the chunk in hand, and writes nothing unless the chunk is full.
    void add(std::uint16_t channel, std::uint64_t log_time_ns, std::span<const std::uint8_t> data);

    /// Writes the chunk in hand, if there is any.
    void end_chunk();

    /// Writes the last chunk, the end of the data and the summary. Nothing may follow.
    void finish();

    /// Bytes in the file, and those of whole records.
    std::uint64_t size() const;
    std::uint64_t intact_size() const;

    /// Messages of a channel that are whole in the file.
    std::uint64_t written(std::uint16_t channel) const;
    std::uint64_t written() const;

private:
    struct State;
    std::unique_ptr<State> state_;
};

}  // namespace quorient::recording::mcap
