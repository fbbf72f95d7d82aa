#include "frame_reader.hpp"

#include "quorient/messages/codes.hpp"
#include "quorient/messages/meaning.hpp"
#include "quorient/messages/sample_time.hpp"
#include "quorient/messages/time.hpp"
#include "samples.hpp"

#include <fmt/format.h>
#include <algorithm>
#include <cmath>

namespace quorient::recording::mcap {
namespace {

constexpr std::uint64_t looked_at_bytes = std::uint64_t{64} << 20U;  // bytes of the file's beginning
constexpr std::size_t most_waiting = 64;                             // frames that wait for their truth
constexpr std::size_t most_descriptions = 64;                        // in the file's beginning
constexpr double longest_interval_s = 3600;
constexpr std::int64_t longest_record_ns = 1'000'000'000'000'000'000;

bool is_complete(const ClusterDescription& description)
{
    if (description.kind != octet(SensorKind::gyro)) return false;
    if (description.axis_count == 0 || description.axis_count > max_axes || description.instrument_count > max_axes) return false;
    return std::all_of(description.instrument.begin(), description.instrument.begin() + description.axis_count,
                       [&](std::uint8_t place) { return place < std::max<std::uint8_t>(1, description.instrument_count); });
}

bool is_complete(const SensorFrame& frame)
{
    return frame.axis_count > 0 && frame.axis_count <= max_axes && is_sample_time(frame.sample_time_ns) && frame.interval_s > 0 &&
           frame.interval_s <= longest_interval_s && frame.sequence < never;
}

bool describes(const ClusterDescription& description, const SensorFrame& frame)
{
    return description.unit == frame.unit && description.epoch == frame.epoch && description.revision == frame.description_revision &&
           description.axis_count == frame.axis_count;
}

bool is_gyros(const SensorFrame& frame)
{
    return frame.kind == octet(SensorKind::gyro);
}

AxisMask usable_axes(const SensorFrame& frame)
{
    AxisMask usable = frame.valid_mask & all_axes(frame.axis_count);
    for (std::size_t axis = 0; axis < frame.axis_count; ++axis)
        if (!std::isfinite(frame.increment[axis])) usable &= ~axis_bit(axis);
    return usable;
}

bool is_attitude(const TruthState& truth)
{
    return truth.attitude_known != 0 && std::all_of(truth.attitude.begin(), truth.attitude.end(), [](double part) { return std::isfinite(part); });
}

}  // namespace

FrameReader::FrameReader(Input input, std::string name) : records_(std::move(input), statistics_), name_(std::move(name)) {}

std::optional<tl::expected<std::unique_ptr<FrameReader>, std::string>> FrameReader::open(Input& input, std::string name)
{
    std::unique_ptr<FrameReader> reader(new FrameReader(std::move(input), std::move(name)));
    const Beginning beginning = reader->look();
    if (!beginning.has_channel && !reader->met_schema_ && reader->records_.met_unknown_compression()) return tl::unexpected(reader->problem_);
    if (!beginning.has_channel) {
        input = reader->records_.release();
        return std::nullopt;
    }
    if (!beginning.frame) {
        return tl::unexpected(reader->problem_.empty() ? fmt::format("{}: no frame of gyros in the first 64 MB", reader->name_) : reader->problem_);
    }
    reader->begin_with(*beginning.frame, beginning.descriptions);
    return reader;
}

/// Finds the first frame and the descriptions about it, and goes back to the beginning.
FrameReader::Beginning FrameReader::look()
{
    Beginning beginning;
    std::uint64_t seen = 0;
    while (seen < looked_at_bytes) {
        const auto step = records_.next();
        if (step == RecordStream::Step::end) break;
        if (step == RecordStream::Step::refused) {
            if (problem_.empty()) refuse(records_.problem());
            continue;
        }
        seen += records_.content().size();
        if (look_at_record(beginning)) break;
    }
    records_.rewind();
    statistics_ = {};
    return beginning;
}

/// @returns whether all is known.
bool FrameReader::look_at_record(Beginning& beginning)
{
    add_names();
    beginning.has_channel = std::any_of(topics_.begin(), topics_.end(), [](const auto& entry) { return entry.second == Topic::frame; });
    const auto message = records_.opcode() == Opcode::message ? parse_message(records_.content()) : std::nullopt;
    if (!message) return false;
    const auto topic = topic_of(message->channel_id);
    if (topic == Topic::frame && !beginning.frame) {
        const auto frame = sample_of<SensorFrame>(message->data);
        if (frame && is_complete(*frame) && is_gyros(*frame)) beginning.frame = frame;
    }
    if (topic == Topic::cluster && beginning.descriptions.size() < most_descriptions) {
        const auto description = sample_of<ClusterDescription>(message->data);
        if (description && is_complete(*description)) beginning.descriptions.push_back(*description);
    }
    return beginning.frame && std::any_of(beginning.descriptions.begin(), beginning.descriptions.end(),
                                          [&](const ClusterDescription& known) { return describes(known, *beginning.frame); });
}

void FrameReader::begin_with(const SensorFrame& first, const std::vector<ClusterDescription>& descriptions)
{
    const auto known = std::find_if(descriptions.begin(), descriptions.end(), [&](const auto& one) { return describes(one, first); });
    if (known != descriptions.end()) {
        description_ = *known;
        description_.bias = {};
        if (first.sequence != 0) description_.initial_attitude_known = octet(InitialAttitude::unknown);
    } else {
        description_.kind = first.kind;
        description_.unit = first.unit;
        description_.axis_count = description_.instrument_count = first.axis_count;
        for (std::uint8_t axis = 0; axis < first.axis_count; ++axis) description_.instrument[axis] = axis;
        description_.interval_s = first.interval_s;
    }
    latest_ = first;
    first_ = identity_of(first);
    problem_.clear();
    origin_ns_ = first.sample_time_ns - nanoseconds(first.interval_s);
}

ReadOutcome FrameReader::next(RecordedFrame& frame)
{
    for (;;) {
        if (is_ready()) return give(frame);
        if (ended_) return ReadOutcome::end;
        const auto step = records_.next();
        if (step == RecordStream::Step::end) ended_ = true;
        else if (step == RecordStream::Step::refused) return refuse(records_.problem());
        else if (const auto refused = record()) return *refused;
    }
}

/// The oldest frame that waits has its truth, or none will come.
bool FrameReader::is_ready() const
{
    if (waiting_.empty()) return false;
    if (ended_ || waiting_.size() > most_waiting) return true;
    return !truths_.empty() && truths_.back().sequence >= waiting_.front().frame.sequence;
}

ReadOutcome FrameReader::give(RecordedFrame& recorded)
{
    const Waiting& oldest = waiting_.front();
    const SensorFrame& frame = oldest.frame;
    recorded = {};
    recorded.time_ns = frame.sample_time_ns - origin_ns_;
    recorded.interval_s = frame.interval_s;
    recorded.axis_count = frame.axis_count;
    recorded.valid_mask = usable_axes(frame);
    for (std::size_t axis = 0; axis < frame.axis_count; ++axis)
        recorded.increment[axis] = has_axis(recorded.valid_mask, axis) ? frame.increment[axis] : 0.0;
    recorded.lost_before = oldest.lost_before;
    recorded.position = oldest.position;
    while (!truths_.empty() && truths_.front().sequence < frame.sequence) truths_.pop_front();
    if (!truths_.empty() && truths_.front().sequence == frame.sequence) recorded.truth = truths_.front().attitude;
    statistics_.lost += oldest.lost_before;
    if (recorded.valid_mask != all_axes(frame.axis_count)) ++statistics_.incomplete;
    statistics_.duration_ns = recorded.time_ns;
    ++statistics_.frames;
    given_sequence_ = frame.sequence;
    waiting_.pop_front();
    return ReadOutcome::frame;
}

/// The record in hand. @returns what is refused of it, if anything
std::optional<ReadOutcome> FrameReader::record()
{
    add_names();
    const auto message = records_.opcode() == Opcode::message ? parse_message(records_.content()) : std::nullopt;
    if (!message) return std::nullopt;
    const auto topic = topic_of(message->channel_id);
    if (topic == Topic::truth) {
        if (const auto truth = sample_of<TruthState>(message->data)) accept(*truth);
    } else if (topic == Topic::frame) {
        const auto frame = sample_of<SensorFrame>(message->data);
        if (frame && frame->unit == latest_.unit && is_gyros(*frame)) return accept(*frame);
        if (!frame) {
            ++statistics_.records;
            return refuse_as(statistics_.malformed, "a frame that is not in little-endian CDR, or of another version");
        }
    }
    return std::nullopt;
}

void FrameReader::accept(const TruthState& truth)
{
    if (truth.epoch != latest_.epoch || truth.unit != latest_.unit || !is_attitude(truth)) return;
    if (!truths_.empty() && truth.sequence <= truths_.back().sequence) return;
    if (truths_.size() > most_waiting) truths_.pop_front();
    truths_.push_back(truth);
}

std::optional<ReadOutcome> FrameReader::accept(const SensorFrame& frame)
{
    ++statistics_.records;
    if (const auto refused = judge(frame)) return refused;
    const std::uint64_t lost = started_ ? frame.sequence - latest_.sequence - 1 : 0;
    const bool continued = static_cast<double>(lost) * frame.interval_s > longest_gap_s;
    if (continued)
        return refuse_as(statistics_.irregular, fmt::format("{} frames are missing, more than an hour; the rotation between is not known", lost));
    started_ = true;
    latest_ = frame;
    waiting_.push_back({frame, lost, records_.position()});
    return std::nullopt;
}

std::optional<ReadOutcome> FrameReader::judge(const SensorFrame& frame)
{
    if (!is_complete(frame) || frame.axis_count != description_.axis_count)
        return refuse_as(statistics_.malformed, "a frame with an impossible number of axes, time or interval");
    if (frame.epoch != latest_.epoch)
        return refuse_as(statistics_.irregular, "a frame of another epoch: the publisher started again, and its attitude is not known");
    if (usable_axes(frame) == 0) return refuse_as(statistics_.nan, "no axis has a finite value");
    if (!started_) return std::nullopt;
    if (frame.sequence <= latest_.sequence)
        return refuse_as(statistics_.repeated, fmt::format("frame {} after {}", frame.sequence, latest_.sequence));
    if (frame.sample_time_ns / 2 - origin_ns_ / 2 > longest_record_ns / 2)
        return refuse_as(statistics_.irregular, "a time decades after the first frame's");
    if (frame.sample_time_ns <= latest_.sample_time_ns) return refuse_as(statistics_.irregular, "a time that does not go forward");
    return std::nullopt;
}

void FrameReader::add_names()
{
    if (records_.opcode() == Opcode::schema) {
        const auto schema = parse_schema(records_.content());
        if (!schema) return;
        met_schema_ = true;
        if (const auto topic = topic_named(schema->name)) schemas_.insert_or_assign(schema->id, *topic);
        else schemas_.erase(schema->id);
    } else if (records_.opcode() == Opcode::channel) {
        const auto channel = parse_channel(records_.content());
        const auto schema = channel ? schemas_.find(channel->schema_id) : schemas_.end();
        if (schema == schemas_.end() || channel->message_encoding != "cdr") return;
        topics_.try_emplace(channel->id, schema->second);
    }
}

std::optional<FrameReader::Topic> FrameReader::topic_named(std::string_view schema)
{
    if (schema == "quorient_msgs::SensorFrame") return Topic::frame;
    if (schema == "quorient_msgs::ClusterDescription") return Topic::cluster;
    if (schema == "quorient_msgs::TruthState") return Topic::truth;
    return std::nullopt;
}

std::optional<FrameReader::Topic> FrameReader::topic_of(std::uint16_t channel) const
{
    const auto found = topics_.find(channel);
    return found == topics_.end() ? std::nullopt : std::optional(found->second);
}

ReadOutcome FrameReader::refuse(std::string_view why)
{
    problem_ = fmt::format("{}: byte {}: {}", name_, records_.position(), why);
    return ReadOutcome::rejected;
}

ReadOutcome FrameReader::refuse_as(std::uint64_t& reason, std::string_view why)
{
    ++reason;
    return refuse(why);
}

}  // namespace quorient::recording::mcap
