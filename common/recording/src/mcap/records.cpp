#include "records.hpp"

#include "bytes/little_endian.hpp"

#include <zlib.h>

namespace quorient::recording::mcap {
namespace {

/// Fields of a record's content, one after the other. Once one does not fit, all() is false and the others are empty.
class Fields {
public:
    explicit Fields(Bytes content) : left_(content) {}

    template <class Number>
    Number number()
    {
        if (left_.size() < sizeof(Number)) return fail<Number>();
        const auto value = little_endian<Number>(left_);
        left_ = left_.subspan(sizeof(Number));
        return value;
    }

    Bytes bytes(std::uint64_t count)
    {
        if (left_.size() < count) return fail<Bytes>();
        const Bytes taken = left_.first(count);
        left_ = left_.subspan(count);
        return taken;
    }

    std::string text()
    {
        const Bytes taken = bytes(number<std::uint32_t>());
        return {taken.begin(), taken.end()};
    }

    Bytes rest() const { return left_; }
    bool all() const { return all_; }

private:
    template <class Value>
    Value fail()
    {
        all_ = false;
        left_ = {};
        return {};
    }

    Bytes left_;
    bool all_ = true;
};

}  // namespace

std::optional<Schema> parse_schema(Bytes content)
{
    Fields fields(content);
    Schema schema;
    schema.id = fields.number<std::uint16_t>();
    schema.name = fields.text();
    return fields.all() ? std::optional(std::move(schema)) : std::nullopt;
}

std::optional<Channel> parse_channel(Bytes content)
{
    Fields fields(content);
    Channel channel;
    channel.id = fields.number<std::uint16_t>();
    channel.schema_id = fields.number<std::uint16_t>();
    channel.topic = fields.text();
    channel.message_encoding = fields.text();
    return fields.all() ? std::optional(std::move(channel)) : std::nullopt;
}

std::optional<Message> parse_message(Bytes content)
{
    Fields fields(content);
    Message message;
    message.channel_id = fields.number<std::uint16_t>();
    fields.number<std::uint32_t>();  // its sequence number
    message.log_time_ns = fields.number<std::uint64_t>();
    fields.number<std::uint64_t>();  // the time of publishing
    message.data = fields.rest();
    return fields.all() ? std::optional(message) : std::nullopt;
}

std::optional<Chunk> parse_chunk_fields(Bytes content)
{
    Fields fields(content);
    Chunk chunk;
    fields.bytes(8 + 8);  // times of its first and last message
    chunk.uncompressed_size = fields.number<std::uint64_t>();
    chunk.uncompressed_crc = fields.number<std::uint32_t>();
    chunk.compression = fields.text();
    chunk.records_size = fields.number<std::uint64_t>();
    return fields.all() ? std::optional(std::move(chunk)) : std::nullopt;
}

std::size_t chunk_fields_size(const Chunk& chunk)
{
    return 8 + 8 + 8 + 4 + 4 + chunk.compression.size() + 8;
}

std::uint32_t crc32(Bytes bytes)
{
    return static_cast<std::uint32_t>(::crc32_z(0, bytes.data(), bytes.size()));
}

}  // namespace quorient::recording::mcap
