#pragma once

#include "bytes/input.hpp"
#include "quorient/recording/reader.hpp"
#include "records.hpp"

namespace quorient::recording::mcap {

bool is_mcap(Bytes beginning);

/// The records of an MCAP file in the order in which they stand, those in chunks too. It is read forward: a file that was cut, or whose
/// summary is missing, is read as far as it goes. Chunks are decompressed whole, so that one that fails its checksum gives nothing.
class RecordStream {
public:
    enum class Step {
        record,   ///< opcode() and content() are filled
        refused,  ///< problem() says what and why; go on reading
        end,
    };

    /// @param counts  what is refused is added here; must live as long as the stream
    RecordStream(Input input, Statistics& counts);

    Step next();

    /// Back to the first record.
    void rewind();

    /// Gives the input back, at its beginning. The stream is of no use afterwards.
    Input release();

    Opcode opcode() const { return opcode_; }

    /// Valid until the next call of next().
    Bytes content() const { return content_; }

    /// Byte offset in the file of the record in hand, or of its chunk.
    std::uint64_t position() const { return position_; }

    /// Why the latest part of the file was refused, without the file's name.
    const std::string& problem() const { return problem_; }

    /// At the end: whether the writer had ended the file's data.
    bool ended_in_order() const { return ended_in_order_; }

    /// Whether a chunk was refused because of how it is compressed.
    bool met_unknown_compression() const { return met_unknown_compression_; }

    double progress() const { return input_.progress(); }

private:
    void begin();
    std::optional<Step> next_in_chunk();
    std::optional<Step> next_in_file();
    std::optional<Step> open_chunk(std::uint64_t length);
    void fill_chunk(const Chunk& fields);
    std::optional<Step> judge_chunk(const Chunk& fields);
    Step give(Opcode opcode, Bytes content);
    Step end_of(std::uint64_t left);
    Step refuse(std::string why);

    Input input_;
    Statistics& counts_;
    Opcode opcode_ = Opcode::header;
    Bytes content_;
    std::size_t held_ = 0;             // bytes of the input that content_ points to
    std::vector<std::uint8_t> chunk_;  // its records
    std::size_t chunk_at_ = 0;         // where its next record begins
    std::uint64_t position_ = 0;
    std::string problem_;
    bool ended_ = false;
    bool ended_in_order_ = false;
    bool met_unknown_compression_ = false;
};

}  // namespace quorient::recording::mcap
