#include "quorient/recording/mcap_writer.hpp"

#include "chunk_builder.hpp"

#include <algorithm>
#include <cassert>
#include <limits>

namespace quorient::recording::mcap {
namespace {

constexpr std::size_t full_chunk = std::size_t{1} << 20U;

void put_chunk_index(RecordBuilder& into, const ChunkBuilder::Placed& chunk)
{
    into.begin(Opcode::chunk_index).number(chunk.first_time_ns).number(chunk.last_time_ns).number(chunk.chunk_start).number(chunk.chunk_length);
    into.begin_list();
    for (const auto& [channel, start] : chunk.index_start) into.number(channel).number(start);
    into.end_list().number(chunk.index_length).text(chunk.compressed_size < chunk.uncompressed_size ? "zstd" : "");
    into.number(chunk.compressed_size).number(chunk.uncompressed_size).end();
}

}  // namespace

struct Writer::State {
    explicit State(std::ostream& stream) : out(stream) {}

    /// What a channel has in the file and in the chunk in hand.
    struct Count {
        std::uint64_t written = 0;
        std::uint64_t added = 0;
    };

    std::ostream& out;
    std::uint64_t size = 0;
    std::uint64_t intact_size = 0;
    RecordBuilder ready;     // what the next write takes
    RecordBuilder schemas;   // all of them, for the summary
    RecordBuilder channels;  // likewise
    std::uint16_t schema_count = 0;
    std::map<std::uint16_t, Count> counts;  // by channel
    ChunkBuilder chunk;
    std::vector<ChunkBuilder::Placed> chunks;

    void write()
    {
        out.write(reinterpret_cast<const char*>(ready.bytes().data()), static_cast<std::streamsize>(ready.size()));
        size += ready.size();
        if (out) intact_size = size;
        ready.clear();
    }

    void put_statistics(RecordBuilder& into) const;
    void put_summary();
};

void Writer::State::put_statistics(RecordBuilder& into) const
{
    std::uint64_t messages = 0;
    std::uint64_t first_ns = chunks.empty() ? 0 : std::numeric_limits<std::uint64_t>::max();
    std::uint64_t last_ns = 0;
    for (const auto& [channel, count] : counts) messages += count.written;
    for (const auto& placed : chunks) {
        first_ns = std::min(first_ns, placed.first_time_ns);
        last_ns = std::max(last_ns, placed.last_time_ns);
    }
    into.begin(Opcode::statistics).number(messages).number(schema_count).number(static_cast<std::uint32_t>(counts.size()));
    into.number(std::uint32_t{0}).number(std::uint32_t{0}).number(static_cast<std::uint32_t>(chunks.size()));  // no attachments, no metadata
    into.number(first_ns).number(last_ns).begin_list();
    for (const auto& [channel, count] : counts) into.number(channel).number(count.written);
    into.end_list().end();
}

/// Groups of records of one kind, where each group stands, and the footer with the checksum of all before.
void Writer::State::put_summary()
{
    RecordBuilder summary;
    RecordBuilder offsets;
    const auto group = [&](Opcode opcode, const auto& put) {
        const std::uint64_t begin = size + summary.size();
        put();
        const std::uint64_t length = size + summary.size() - begin;
        if (length > 0) offsets.begin(Opcode::summary_offset).number(static_cast<std::uint8_t>(opcode)).number(begin).number(length).end();
    };
    group(Opcode::schema, [&] { summary.raw(schemas.bytes()); });
    group(Opcode::channel, [&] { summary.raw(channels.bytes()); });
    group(Opcode::statistics, [&] { put_statistics(summary); });
    group(Opcode::chunk_index, [&] {
        for (const auto& placed : chunks) put_chunk_index(summary, placed);
    });
    const std::uint64_t offsets_start = size + summary.size();
    summary.raw(offsets.bytes());
    constexpr std::uint64_t footer_size = 8 + 8 + 4;
    summary.number(static_cast<std::uint8_t>(Opcode::footer)).number(footer_size).number(size).number(offsets_start);
    summary.number(crc32(summary.bytes()));  // it covers the footer too, as far as it stands before it
    ready.raw(summary.bytes()).raw(magic);
}

Writer::Writer(std::ostream& out, std::string_view library) : state_(std::make_unique<State>(out))
{
    state_->ready.raw(magic).begin(Opcode::header).text("").text(library).end();
}

Writer::~Writer() = default;

std::uint16_t Writer::add_schema(std::string_view name, std::string_view encoding, std::string_view text)
{
    RecordBuilder record;
    record.begin(Opcode::schema).number(++state_->schema_count).text(name).text(encoding).text(text).end();
    state_->schemas.raw(record.bytes());
    state_->ready.raw(record.bytes());
    return state_->schema_count;
}

std::uint16_t Writer::add_channel(std::string_view topic, std::string_view message_encoding, std::uint16_t schema)
{
    assert(state_->chunk.empty() && state_->chunks.empty());
    const auto id = static_cast<std::uint16_t>(state_->counts.size() + 1);
    state_->counts[id] = {};
    RecordBuilder record;
    record.begin(Opcode::channel).number(id).number(schema).text(topic).text(message_encoding).begin_list().end_list().end();
    state_->channels.raw(record.bytes());
    state_->ready.raw(record.bytes());
    return id;
}

void Writer::add(std::uint16_t channel, std::uint64_t log_time_ns, std::span<const std::uint8_t> data)
{
    if (state_->ready.size() > 0) state_->write();  // schemas and channels, before the first message
    State::Count& count = state_->counts.at(channel);
    state_->chunk.add({channel, log_time_ns, data}, static_cast<std::uint32_t>(count.written + count.added));
    ++count.added;
    if (state_->chunk.size() >= full_chunk) end_chunk();
}

void Writer::end_chunk()
{
    if (state_->chunk.empty()) return;
    state_->chunks.push_back(state_->chunk.write(state_->ready, state_->size));
    state_->write();
    for (auto& [channel, count] : state_->counts) {
        if (state_->out) count.written += count.added;
        count.added = 0;
    }
}

void Writer::finish()
{
    end_chunk();
    state_->ready.begin(Opcode::data_end).number(std::uint32_t{0}).end();  // no checksum of the data as a whole: each chunk has its own
    state_->write();
    state_->put_summary();
    state_->write();
}

std::uint64_t Writer::size() const
{
    return state_->size;
}

std::uint64_t Writer::intact_size() const
{
    return state_->intact_size;
}

std::uint64_t Writer::written(std::uint16_t channel) const
{
    return state_->counts.at(channel).written;
}

std::uint64_t Writer::written() const
{
    std::uint64_t sum = 0;
    for (const auto& [channel, count] : state_->counts) sum += count.written;
    return sum;
}

}  // namespace quorient::recording::mcap
