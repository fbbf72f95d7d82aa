#pragma once

#include "bytes.hpp"

#include <lz4frame.h>
#include <zlib.h>
#include <zstd.h>
#include <algorithm>
#include <optional>

namespace quorient::recording::test {

using ByteVector = std::vector<std::uint8_t>;

inline void put_text(Bytes& bytes, const std::string& text)
{
    bytes.put(static_cast<std::uint32_t>(text.size())).put(text);
}

/// A sensor_msgs/Imu in CDR of either byte order.
inline ByteVector cdr_imu(std::int32_t seconds, std::uint32_t nanoseconds, const std::array<double, 3>& rate, const std::string& frame = "imu_link",
                          bool little_endian = true, bool has_rate = true)
{
    Bytes body;
    const auto number = [&](auto value) {
        while (body.data.size() % sizeof value != 0) body.put(std::uint8_t{0});
        Bytes one;
        one.put(value);
        if (!little_endian) std::reverse(one.data.begin(), one.data.end());
        body.data.insert(body.data.end(), one.data.begin(), one.data.end());
    };
    number(seconds);
    number(nanoseconds);
    number(static_cast<std::uint32_t>(frame.size() + 1));
    body.put(frame).put(std::uint8_t{0});
    for (const double value : {0.0, 0.0, 0.0, 1.0}) number(value);
    for (int i = 0; i < 9; ++i) number(0.5);
    for (const double value : rate) number(value);
    number(has_rate ? 0.25 : -1.0);
    for (int i = 0; i < 8; ++i) number(0.25);
    for (const double value : {0.1, 0.2, 9.8}) number(value);
    for (int i = 0; i < 9; ++i) number(0.125);
    Bytes message;
    message.put(std::array<std::uint8_t, 4>{0, static_cast<std::uint8_t>(little_endian ? 1 : 0), 0, 0});
    message.data.insert(message.data.end(), body.data.begin(), body.data.end());
    return message.data;
}

/// The same as ROS 1 has it.
inline ByteVector ros1_imu(std::uint32_t seconds, std::uint32_t nanoseconds, const std::array<double, 3>& rate)
{
    Bytes message;
    message.put(std::uint32_t{7}).put(seconds).put(nanoseconds);
    put_text(message, "imu");
    for (int i = 0; i < 4 + 9; ++i) message.put(0.0);
    message.put(rate);
    for (int i = 0; i < 9; ++i) message.put(0.0);
    message.put(std::array<double, 3>{0.1, 0.2, 9.8});
    for (int i = 0; i < 9; ++i) message.put(0.0);
    return message.data;
}

/// Writes MCAP files.
class McapWriter {
public:
    McapWriter()
    {
        put_magic();
        Bytes header;
        put_text(header, "ros2");
        put_text(header, "a test");
        record(log, 0x01, header);
    }

    static void record(Bytes& into, std::uint8_t opcode, const Bytes& content)
    {
        into.put(opcode).put(static_cast<std::uint64_t>(content.data.size()));
        into.data.insert(into.data.end(), content.data.begin(), content.data.end());
    }

    static void schema(Bytes& into, std::uint16_t id, const std::string& name, const std::string& encoding = "ros2msg")
    {
        Bytes content;
        content.put(id);
        put_text(content, name);
        put_text(content, encoding);
        put_text(content, "std_msgs/Header header …");
        record(into, 0x03, content);
    }

    static void channel(Bytes& into, std::uint16_t id, std::uint16_t schema_id, const std::string& topic, const std::string& encoding = "cdr")
    {
        Bytes metadata;
        put_text(metadata, "offered_qos_profiles");
        put_text(metadata, "");
        Bytes content;
        content.put(id).put(schema_id);
        put_text(content, topic);
        put_text(content, encoding);
        content.put(static_cast<std::uint32_t>(metadata.data.size()));
        content.data.insert(content.data.end(), metadata.data.begin(), metadata.data.end());
        record(into, 0x04, content);
    }

    static void message(Bytes& into, std::uint16_t channel_id, std::uint64_t log_time_ns, const ByteVector& data)
    {
        Bytes content;
        content.put(channel_id).put(std::uint32_t{0}).put(log_time_ns).put(log_time_ns);
        content.data.insert(content.data.end(), data.begin(), data.end());
        record(into, 0x05, content);
    }

    /// @param crc  of the records; nothing = the right one
    void chunk(const Bytes& records, const std::string& compression = "", std::optional<std::uint32_t> crc = std::nullopt)
    {
        const auto right = static_cast<std::uint32_t>(crc32(0, records.data.data(), static_cast<uInt>(records.data.size())));
        Bytes content;
        content.put(std::uint64_t{0}).put(std::uint64_t{1}).put(static_cast<std::uint64_t>(records.data.size())).put(crc.value_or(right));
        put_text(content, compression);
        const ByteVector stored = packed(records.data, compression);
        content.put(static_cast<std::uint64_t>(stored.size()));
        content.data.insert(content.data.end(), stored.begin(), stored.end());
        record(log, 0x06, content);
    }

    /// The end of the data, a footer without a summary, and the magic again.
    void finish()
    {
        record(log, 0x0F, Bytes().put(std::uint32_t{0}));
        record(log, 0x02, Bytes().put(std::uint64_t{0}).put(std::uint64_t{0}).put(std::uint32_t{0}));
        put_magic();
    }

    Bytes log;

private:
    void put_magic() { log.put(std::array<std::uint8_t, 8>{0x89, 'M', 'C', 'A', 'P', 0x30, '\r', '\n'}); }

    static ByteVector packed(const ByteVector& plain, const std::string& compression)
    {
        if (compression == "zstd") {
            ByteVector result(ZSTD_compressBound(plain.size()));
            result.resize(ZSTD_compress(result.data(), result.size(), plain.data(), plain.size(), 3));
            return result;
        }
        if (compression == "lz4") {
            ByteVector result(LZ4F_compressFrameBound(plain.size(), nullptr));
            result.resize(LZ4F_compressFrame(result.data(), result.size(), plain.data(), plain.size(), nullptr));
            return result;
        }
        return plain;
    }
};

/// Two IMUs at 100 Hz, in chunks of ten messages.
inline ByteVector mcap_of_two_imus(std::size_t rows, const std::string& compression)
{
    McapWriter writer;
    Bytes records;
    for (std::size_t row = 0; row < rows; ++row) {
        if (row == 0) {
            McapWriter::schema(records, 1, "sensor_msgs/msg/Imu");
            McapWriter::schema(records, 2, "sensor_msgs/msg/Image");
            McapWriter::channel(records, 1, 1, "/imu/left");
            McapWriter::channel(records, 2, 1, "/imu/right");
            McapWriter::channel(records, 3, 2, "/camera");
        }
        const auto nanoseconds = static_cast<std::uint32_t>(10'000'000 * row);
        const double rate = 0.01 * static_cast<double>(row);
        McapWriter::message(records, 1, 5'000'000'000, cdr_imu(100, nanoseconds, {rate, 0, 0}));
        McapWriter::message(records, 2, 5'000'000'000, cdr_imu(100, nanoseconds + 3'000'000, {0, rate, 0}, "r", false));
        McapWriter::message(records, 3, 5'000'000'000, ByteVector(200, 0x55));
        if (row % 10 != 9) continue;
        writer.chunk(records, compression);
        records = {};
    }
    writer.chunk(records, compression);
    writer.finish();
    return writer.log.data;
}

}  // namespace quorient::recording::test
