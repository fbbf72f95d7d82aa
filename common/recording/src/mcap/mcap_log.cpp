#include "mcap_log.hpp"

#include "ros/imu_message.hpp"

#include <fmt/format.h>
#include <algorithm>

namespace quorient::recording::mcap {
namespace {

bool is_imu(std::string_view schema) { return schema == "sensor_msgs/msg/Imu" || schema == "sensor_msgs/Imu"; }

}  // namespace

McapLog::McapLog(Input input, std::string name) : records_(std::move(input), statistics_), name_(std::move(name))
{
    format_ = "MCAP";
}

ReadOutcome McapLog::next(InstrumentSample& sample)
{
    for (;;) {
        const auto step = records_.next();
        if (step == RecordStream::Step::end) return end();
        if (step == RecordStream::Step::refused) return refuse(records_.problem());
        if (const auto outcome = record(sample)) return *outcome;
    }
}

/// The record in hand; nothing if it gives no sample.
std::optional<ReadOutcome> McapLog::record(InstrumentSample& sample)
{
    const Bytes content = records_.content();
    if (records_.opcode() == Opcode::schema) {
        const auto schema = parse_schema(content);
        if (schema && is_imu(schema->name)) schemas_.insert(schema->id);
        else if (schema) schemas_.erase(schema->id);
    } else if (records_.opcode() == Opcode::channel) {
        add_channel(content);
    } else if (records_.opcode() == Opcode::message) {
        if (const auto parsed = parse_message(content)) return message(*parsed, sample);
    }
    return std::nullopt;
}

void McapLog::add_channel(Bytes content)
{
    const auto channel = parse_channel(content);
    if (!channel) return;
    if (!schemas_.contains(channel->schema_id) || (channel->message_encoding != "cdr" && channel->message_encoding != "ros1")) return;
    topics_.try_emplace(channel->id, Topic{channel->topic, channel->message_encoding == "ros1", std::nullopt});
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
    sample.position = records_.position();
    ++statistics_.frames;
    return ReadOutcome::frame;
}

ReadOutcome McapLog::end()
{
    if (!records_.ended_in_order() && remarks_.empty()) remarks_.emplace_back("the recording did not end in order: it has no end of its data");
    return ReadOutcome::end;
}

ReadOutcome McapLog::refuse(std::string_view why)
{
    problem_ = fmt::format("{}: byte {}: {}", name_, records_.position(), why);
    return ReadOutcome::rejected;
}

}  // namespace quorient::recording::mcap
