#pragma once

#include "record_builder.hpp"

#include <map>
#include <memory>

struct ZSTD_CCtx_s;

namespace quorient::recording::mcap {

/// Messages that become one chunk, and their index.
class ChunkBuilder {
public:
    ChunkBuilder();
    ~ChunkBuilder();

    void add(const Message& message, std::uint32_t sequence);

    bool empty() const { return records_.size() == 0; }
    std::size_t size() const { return records_.size(); }  ///< uncompressed, of its records

    /// Where the parts of a chunk came to stand.
    struct Placed {
        std::uint64_t first_time_ns = 0;
        std::uint64_t last_time_ns = 0;
        std::uint64_t chunk_start = 0;   ///< in the file
        std::uint64_t chunk_length = 0;  ///< the whole record, with its header
        std::map<std::uint16_t, std::uint64_t> index_start;  ///< in the file, of each channel's MessageIndex
        std::uint64_t index_length = 0;                      ///< all of them together
        std::uint64_t compressed_size = 0;
        std::uint64_t uncompressed_size = 0;
    };

    /// Appends the chunk, compressed by zstd, and its MessageIndexes; then the chunk is empty again.
    /// @param file_size  where in the file the first byte of `into` will stand
    Placed write(RecordBuilder& into, std::uint64_t file_size);

private:
    struct Entry {
        std::uint64_t time_ns;
        std::uint64_t offset;  // in the uncompressed records
    };

    void write_index(RecordBuilder& into, std::uint64_t file_size, Placed& placed);

    RecordBuilder records_;
    std::map<std::uint16_t, std::vector<Entry>> entries_;  // by channel
    std::uint64_t first_time_ns_ = 0;
    std::uint64_t last_time_ns_ = 0;
    std::unique_ptr<ZSTD_CCtx_s, std::size_t (*)(ZSTD_CCtx_s*)> compressor_;
    std::vector<std::uint8_t> compressed_;
};

}  // namespace quorient::recording::mcap
