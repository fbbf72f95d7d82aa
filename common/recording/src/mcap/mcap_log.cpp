#include "mcap_log.hpp"

#include "bytes/little_endian.hpp"
#include "ros/imu_message.hpp"

#include <fmt/format.h>
#include <algorithm>
#include <limits>

namespace quorient::recording::mcap {
namespace {

constexpr std::uint64_t largest_chunk = std::uint64_t{96} << 20U;   // uncompressed; writers make them of 1 to 4 MiB
constexpr std::uint64_t largest_record = std::uint64_t{1} << 20U;  // that is looked at; others (images) are passed over
constexpr std::size_t read_at_once = std::size_t{1} << 20U;

/// The next bytes of an input, as a source of their own.
class Part final : public ByteSource {
public:
    Part(Input& whole, std::uint64_t size) : whole_(whole), left_(size) {}

    std::size_t read(std::span<std::uint8_t> into) override
    {
        std::size_t count = 0;
        while (count < into.size() && left_ > 0) {
            const Bytes there = whole_.peek(1);
            const std::size_t taken = std::min({there.size(), into.size() - count, static_cast<std::size_t>(std::min<std::uint64_t>(left_, SIZE_MAX))});
            if (taken == 0) break;
            std::copy_n(there.begin(), taken, into.begin() + static_cast<std::ptrdiff_t>(count));
            whole_.take(taken);
            count += taken;
            left_ -= taken;
        }
        return count;
    }

    void rewind() override {}  // nobody does: a part is read once
    double progress() const override { return whole_.progress(); }
    std::uint64_t left() const { return left_; }

private:
    Input& whole_;
    std::uint64_t left_;
};

bool is_known(Opcode opcode)
{
    return opcode >= Opcode::header && opcode <= Opcode::data_end;
}

}  // namespace

bool is_mcap(Bytes beginning)
{
    return beginning.size() >= magic.size() && std::equal(magic.begin(), magic.end(), beginning.begin());
}

McapLog::McapLog(Input input, std::string name) : input_(std::move(input)), name_(std::move(name))
{
    format_ = "MCAP";
    if (is_mcap(input_.peek(magic.size()))) input_.take(magic.size());
}

ReadOutcome McapLog::next(InstrumentSample& sample)
{
    for (;;) {
        const auto outcome = chunk_at_ < chunk_.size() ? next_in_chunk(sample) : next_in_file(sample);
        if (outcome) return *outcome;
    }
}

/// One record of the chunk in hand; nothing if it gives no sample.
std::optional<ReadOutcome> McapLog::next_in_chunk(InstrumentSample& sample)
{
    const Bytes left = Bytes(chunk_).subspan(chunk_at_);
    const std::uint64_t length = left.size() < record_header_size ? left.size() : little_endian<std::uint64_t>(left, 1);
    if (left.size() < record_header_size || left.size() - record_header_size < length) {
        statistics_.truncated_bytes += left.size();
        chunk_at_ = chunk_.size();
        return refuse(fmt::format("the chunk ends {} bytes into a record", left.size()));
    }
    chunk_at_ += record_header_size + static_cast<std::size_t>(length);
    return record(static_cast<Opcode>(left[0]), left.subspan(record_header_size, static_cast<std::size_t>(length)), sample);
}

/// One record of the file itself.
std::optional<ReadOutcome> McapLog::next_in_file(InstrumentSample& sample)
{
    Bytes bytes = input_.peek(record_header_size);
    record_ = input_.offset();
    if (bytes.size() < record_header_size) return end_of(bytes.size());
    const auto opcode = static_cast<Opcode>(bytes[0]);
    const auto length = little_endian<std::uint64_t>(bytes, 1);
    if (opcode == Opcode::footer || opcode == Opcode::data_end) {
        while (input_.skip(read_at_once) > 0) continue;  // the summary repeats what was read
        ended_ = true;
        return ReadOutcome::end;
    }
    if (!is_known(opcode)) {
        ++statistics_.records;
        ++statistics_.malformed;
        statistics_.skipped_bytes += input_.skip(std::numeric_limits<std::uint64_t>::max());
        ended_ = true;
        return refuse(fmt::format("no known record starts here; the {} bytes behind it are not read", statistics_.skipped_bytes));
    }
    if (opcode == Opcode::chunk) return open_chunk(length);
    if (length > largest_record) {
        input_.take(record_header_size);
        const std::uint64_t passed = input_.skip(length);
        return passed < length ? std::optional(end_of(passed)) : std::nullopt;
    }
    const auto size = record_header_size + static_cast<std::size_t>(length);
    bytes = input_.peek(size);
    if (bytes.size() < size) return end_of(bytes.size());
    const auto outcome = record(opcode, bytes.subspan(record_header_size, size - record_header_size), sample);
    input_.take(size);
    return outcome;
}

std::optional<ReadOutcome> McapLog::record(Opcode opcode, Bytes content, InstrumentSample& sample)
{
    if (opcode == Opcode::schema) {
        if (auto schema = parse_schema(content)) schemas_.insert_or_assign(schema->id, std::move(schema->name));
    } else if (opcode == Opcode::channel) {
        add_channel(content);
    } else if (opcode == Opcode::message) {
        if (const auto parsed = parse_message(content)) return message(*parsed, sample);
    }
    return std::nullopt;
}

void McapLog::add_channel(Bytes content)
{
    const auto channel = parse_channel(content);
    if (!channel) return;
    const auto schema = schemas_.find(channel->schema_id);
    const bool imu = schema != schemas_.end() && (schema->second == "sensor_msgs/msg/Imu" || schema->second == "sensor_msgs/Imu");
    if (!imu || (channel->message_encoding != "cdr" && channel->message_encoding != "ros1")) return;
    topics_.try_emplace(channel->id, Topic{channel->topic, channel->message_encoding == "ros1", std::nullopt});
}

/// Decompresses a chunk and checks it. A chunk that was cut is kept as far as it goes.
std::optional<ReadOutcome> McapLog::open_chunk(std::uint64_t length)
{
    const Bytes beginning = input_.peek(record_header_size + chunk_fields_size({}) + longest_compression);
    const auto fields = parse_chunk_fields(beginning.subspan(record_header_size));
    const bool sound = fields && chunk_fields_size(*fields) <= length && fields->records_size <= length - chunk_fields_size(*fields);
    if (!sound || fields->uncompressed_size > largest_chunk) {
        ++statistics_.records;
        ++statistics_.malformed;
        input_.take(record_header_size);
        statistics_.skipped_bytes += input_.skip(length);
        return refuse(sound ? fmt::format("a chunk of {} MB is too large", fields->uncompressed_size >> 20U)
                            : std::string("a chunk whose fields contradict its length"));
    }
    input_.take(record_header_size + chunk_fields_size(*fields));
    auto part = std::make_unique<Part>(input_, fields->records_size);
    const Part& stored = *part;
    std::unique_ptr<ByteSource> records = std::move(part);
    if (fields->compression == "zstd") records = zstd_source(std::move(records));
    else if (fields->compression == "lz4") records = lz4_source(std::move(records));
    chunk_.clear();
    chunk_at_ = 0;
    while (chunk_.size() < fields->uncompressed_size) {
        const std::size_t begin = chunk_.size();
        chunk_.resize(std::min<std::size_t>(begin + read_at_once, static_cast<std::size_t>(fields->uncompressed_size)));
        const std::size_t count = records->read(std::span(chunk_).subspan(begin));
        chunk_.resize(begin + count);
        if (count == 0) break;
    }
    input_.skip(stored.left());
    const bool cut = chunk_.size() < fields->uncompressed_size;
    const bool unknown = !fields->compression.empty() && fields->compression != "zstd" && fields->compression != "lz4";
    const bool broken = !cut && fields->uncompressed_crc != 0 && crc32(chunk_) != fields->uncompressed_crc;
    if (!unknown && !broken && !cut) return std::nullopt;
    ++statistics_.records;
    ++(broken ? statistics_.checksum_failures : statistics_.malformed);
    if (unknown || broken) chunk_.clear();
    if (unknown) return refuse(fmt::format("a chunk compressed by '{}', which is not known", fields->compression));
    if (broken) return refuse("a chunk whose checksum is wrong: its messages are left out");
    return refuse(fmt::format("a chunk is cut: {} of {} bytes are read", chunk_.size(), fields->uncompressed_size));
}

std::optional<ReadOutcome> McapLog::message(const Message& message, InstrumentSample& sample)
{
    const auto found = topics_.find(message.channel_id);
    if (found == topics_.end()) return std::nullopt;
    Topic& topic = found->second;
    ++statistics_.records;
    const auto imu = topic.ros1 ? ros::parse_ros1_imu(message.data) : ros::parse_stored_imu(message.data);
    if (!imu) {
        ++statistics_.malformed;
        return refuse(fmt::format("{}: not a sensor_msgs/Imu", topic.name));
    }
    if (!topic.place) topic.place = place_of(ros::instrument_of(topic.name));
    if (!topic.place) {
        ++statistics_.malformed;
        return refuse(fmt::format("{}: more than {} instruments", topic.name, max_instruments));
    }
    const auto made = ros::sample_of(*imu, static_cast<std::int64_t>(std::min<std::uint64_t>(message.log_time_ns, INT64_MAX / 2)));
    if (!made) {
        ++statistics_.incomplete;
        return std::nullopt;
    }
    sample = *made;
    sample.instrument = *topic.place;
    sample.position = record_;
    ++statistics_.frames;
    return ReadOutcome::frame;
}

ReadOutcome McapLog::end_of(std::uint64_t left)
{
    input_.take(input_.peek(1).size());
    if (ended_) return ReadOutcome::end;
    ended_ = true;
    statistics_.truncated_bytes += left;
    if (!input_.trouble().empty()) return refuse(input_.trouble());
    remarks_.emplace_back("the recording did not end in order: it has no end of its data");
    return left > 0 ? refuse(fmt::format("the log ends {} bytes into a record", left)) : ReadOutcome::end;
}

ReadOutcome McapLog::refuse(std::string_view why)
{
    problem_ = fmt::format("{}: byte {}: {}", name_, record_, why);
    return ReadOutcome::rejected;
}

}  // namespace quorient::recording::mcap
