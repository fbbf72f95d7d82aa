#include "chunk_builder.hpp"

#include <zstd.h>
#include <algorithm>

namespace quorient::recording::mcap {
namespace {

constexpr int compression_level = 1;  // the fastest of zstd's usual ones

}  // namespace

ChunkBuilder::ChunkBuilder() : compressor_(ZSTD_createCCtx(), ZSTD_freeCCtx) {}

ChunkBuilder::~ChunkBuilder() = default;

void ChunkBuilder::add(const Message& message, std::uint32_t sequence)
{
    first_time_ns_ = empty() ? message.log_time_ns : std::min(first_time_ns_, message.log_time_ns);
    last_time_ns_ = empty() ? message.log_time_ns : std::max(last_time_ns_, message.log_time_ns);
    entries_[message.channel_id].push_back({message.log_time_ns, records_.size()});
    records_.begin(Opcode::message).number(message.channel_id).number(sequence).number(message.log_time_ns);
    records_.number(message.log_time_ns);  // the time of publishing: not known, and the format then wants that of storing
    records_.raw(message.data).end();
}

ChunkBuilder::Placed ChunkBuilder::write(RecordBuilder& into, std::uint64_t file_size)
{
    compressed_.resize(ZSTD_compressBound(records_.size()));
    const std::size_t compressed =
        ZSTD_compressCCtx(compressor_.get(), compressed_.data(), compressed_.size(), records_.bytes().data(), records_.size(), compression_level);
    const bool smaller = ZSTD_isError(compressed) == 0 && compressed < records_.size();
    const Bytes stored = smaller ? Bytes(compressed_).first(compressed) : records_.bytes();

    Placed placed;
    placed.first_time_ns = first_time_ns_;
    placed.last_time_ns = last_time_ns_;
    placed.chunk_start = file_size + into.size();
    placed.compressed_size = stored.size();
    placed.uncompressed_size = records_.size();
    into.begin(Opcode::chunk).number(first_time_ns_).number(last_time_ns_).number(std::uint64_t{records_.size()}).number(crc32(records_.bytes()));
    into.text(smaller ? "zstd" : "").number(std::uint64_t{stored.size()}).raw(stored).end();
    placed.chunk_length = file_size + into.size() - placed.chunk_start;
    write_index(into, file_size, placed);
    records_.clear();
    for (auto& [channel, entries] : entries_) entries.clear();
    return placed;
}

void ChunkBuilder::write_index(RecordBuilder& into, std::uint64_t file_size, Placed& placed)
{
    const std::size_t begin = into.size();
    for (const auto& [channel, entries] : entries_) {
        if (entries.empty()) continue;
        placed.index_start[channel] = file_size + into.size();
        into.begin(Opcode::message_index).number(channel).begin_list();
        for (const Entry& entry : entries) into.number(entry.time_ns).number(entry.offset);
        into.end_list().end();
    }
    placed.index_length = into.size() - begin;
}

}  // namespace quorient::recording::mcap
