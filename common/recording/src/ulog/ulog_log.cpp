#include "ulog_log.hpp"

#include "bytes/little_endian.hpp"

#include <fmt/format.h>
#include <algorithm>

namespace quorient::recording::ulog {
namespace {

constexpr std::array<std::uint8_t, 7> file_magic{'U', 'L', 'o', 'g', 0x01, 0x12, 0x35};
constexpr std::size_t file_header_size = 16;
constexpr std::size_t header_size = 3;  // u16 size of the content, u8 type
constexpr std::string_view known_types = "BFIMPQARDLCSO";
// A synchronisation message whole: its header, and the magic that nothing else contains.
constexpr std::array<std::uint8_t, 11> sync{0x08, 0x00, 'S', 0x2F, 0x73, 0x13, 0x20, 0x25, 0x0C, 0xBB, 0x12};

std::string_view text_of(Bytes bytes)
{
    return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
}

}  // namespace

bool is_ulog(Bytes beginning)
{
    return beginning.size() >= file_header_size && std::equal(file_magic.begin(), file_magic.end(), beginning.begin());
}

UlogLog::UlogLog(Input input, std::string name) : input_(std::move(input)), name_(std::move(name))
{
    format_ = "PX4 ULog";
    input_.take(std::min(file_header_size, input_.peek(file_header_size).size()));
}

tl::expected<std::unique_ptr<InstrumentLog>, std::string> UlogLog::open(Input input, std::string name)
{
    std::unique_ptr<UlogLog> log(new UlogLog(std::move(input), std::move(name)));
    if (const auto problem = log->read_flags()) return tl::unexpected(fmt::format("{}: byte {}: {}", log->name_, file_header_size, *problem));
    return log;
}

/// The flags stand in the first message, if anywhere.
std::optional<std::string> UlogLog::read_flags()
{
    constexpr std::size_t content_size = 40;  // 8 compatible flags, 8 others, 3 offsets
    const Bytes bytes = input_.peek(header_size + content_size);
    if (bytes.size() < header_size + content_size || bytes[2] != 'B' || little_endian<std::uint16_t>(bytes) < content_size)
        return std::nullopt;
    const Bytes flags = bytes.subspan(header_size + 8, 8);
    if ((flags[0] & ~1U) != 0 || std::any_of(flags.begin() + 1, flags.end(), [](std::uint8_t flag) { return flag != 0; }))
        return "the log needs a newer reader: its flags are not known";
    for (std::size_t i = 0; i < 3 && (flags[0] & 1U) != 0; ++i) {
        const auto offset = little_endian<std::uint64_t>(bytes, header_size + 16 + 8 * i);
        if (offset > file_header_size) appended_.push_back(offset);
    }
    std::sort(appended_.begin(), appended_.end());
    return std::nullopt;
}

ReadOutcome UlogLog::next(InstrumentSample& sample)
{
    for (;;) {
        if (given_ < waiting_.size()) return give(*waiting_for_, waiting_[given_++], waiting_device_, sample);
        Bytes bytes = input_.peek(header_size);
        record_ = input_.offset();
        while (!appended_.empty() && appended_.front() <= record_) appended_.erase(appended_.begin());
        if (bytes.size() < header_size) return end_of(bytes.size());
        const std::size_t length = header_size + little_endian<std::uint16_t>(bytes);
        if (!appended_.empty() && record_ + length > appended_.front()) {
            pass_to_appended(appended_.front());
            continue;
        }
        if (known_types.find(static_cast<char>(bytes[2])) == std::string_view::npos) return resynchronise();
        bytes = input_.peek(length);
        if (bytes.size() < length) return end_of(bytes.size());
        const auto outcome = message(bytes[2], bytes.subspan(header_size, length - header_size), sample);
        input_.take(length);
        if (outcome) return *outcome;
    }
}

/// Data appended after a crash begins at an offset of its own; the message before it may be cut.
void UlogLog::pass_to_appended(std::uint64_t offset)
{
    statistics_.truncated_bytes += input_.skip(offset - record_);
    remarks_.push_back(fmt::format("data appended at byte {}, as after a crash", offset));
}

std::optional<ReadOutcome> UlogLog::message(std::uint8_t type, Bytes content, InstrumentSample& sample)
{
    switch (type) {
        case 'F':
            if (!definitions_.add(text_of(content))) {
                ++statistics_.records;
                ++statistics_.malformed;
                return refuse("a message type's definition makes no sense");
            }
            break;
        case 'A': subscribe(content); break;
        case 'R':
            if (content.size() >= 2) subscriptions_.erase(little_endian<std::uint16_t>(content));
            break;
        case 'D': return data(content, sample);
        case 'O': note_dropout(content); break;
        default: break;
    }
    return std::nullopt;
}

void UlogLog::subscribe(Bytes content)
{
    if (content.size() < 4) return;
    Subscription subscription;
    subscription.instance = content[0];
    subscription.topic = text_of(content.subspan(3));
    const std::string& topic = subscription.topic;
    subscription.imu = imu_topic(definitions_, topic);
    subscription.fifo = fifo_topic(definitions_, topic);
    if (topic == "sensor_selection") subscription.selected_device = definitions_.field(topic, "gyro_device_id");
    if (topic == "vehicle_imu_status") {
        subscription.status_device = definitions_.field(topic, "gyro_device_id");
        subscription.status_temperature = definitions_.field(topic, "temperature_gyro");
    }
    const bool of_imus = topic == "sensor_gyro" || topic == "vehicle_imu" || topic == "sensor_combined";
    if (of_imus && !subscription.imu) remarks_.push_back(fmt::format("{} is not read: its fields are not those of a gyro", topic));
    subscriptions_.insert_or_assign(little_endian<std::uint16_t>(content, 1), std::move(subscription));
}

std::optional<ReadOutcome> UlogLog::data(Bytes content, InstrumentSample& sample)
{
    if (content.size() < 2) return std::nullopt;
    const auto found = subscriptions_.find(little_endian<std::uint16_t>(content));
    if (found == subscriptions_.end()) return std::nullopt;
    Subscription& subscription = found->second;
    const Bytes fields = content.subspan(2);
    note_status(subscription, fields);
    if (subscription.fifo) {
        waiting_.clear();
        given_ = 0;
        samples_of(*subscription.fifo, fields, waiting_);
        waiting_for_ = &subscription;
        waiting_device_ = subscription.fifo->device ? integer_at(fields, *subscription.fifo->device) : std::nullopt;
        return std::nullopt;
    }
    if (!subscription.imu) return std::nullopt;
    const auto made = sample_of(*subscription.imu, fields);
    if (!made) {
        ++statistics_.records;
        ++statistics_.malformed;
        return refuse(fmt::format("{}.{}: cut, or it covers no time", subscription.topic, subscription.instance));
    }
    const auto device = subscription.imu->device ? integer_at(fields, *subscription.imu->device) : std::nullopt;
    return give(subscription, *made, device, sample);
}

ReadOutcome UlogLog::give(Subscription& subscription, InstrumentSample made, std::optional<std::uint64_t> device, InstrumentSample& sample)
{
    ++statistics_.records;
    const std::uint64_t device_id = device.value_or(0);
    if (!subscription.place) {
        Instrument instrument;
        instrument.name = subscription.topic == "sensor_combined" ? subscription.topic
                                                                  : fmt::format("{}.{}", subscription.topic, subscription.instance);
        instrument.source = subscription.topic;
        instrument.stamps = StampKind::sampling;
        instrument.device = device_id;
        subscription.place = place_of(instrument);
    }
    if (!subscription.place) {
        ++statistics_.malformed;
        return refuse(fmt::format("{}: more than {} instruments", subscription.topic, max_instruments));
    }
    sample = made;
    sample.instrument = *subscription.place;
    sample.position = record_;
    if (std::isnan(sample.temperature_c))
        if (const auto known = temperature_c_.find(device_id); known != temperature_c_.end()) sample.temperature_c = known->second;
    ++statistics_.frames;
    return ReadOutcome::frame;
}

/// What other topics say of the instruments: which one is flown by, how warm one is.
void UlogLog::note_status(const Subscription& subscription, Bytes fields)
{
    const auto number = [&](const std::optional<Field>& field) { return field ? number_at(fields, *field) : std::nullopt; };
    const auto device_of = [&](const std::optional<Field>& field) { return field ? integer_at(fields, *field) : std::nullopt; };
    if (const auto device = device_of(subscription.selected_device)) {
        const auto time = definitions_.field(subscription.topic, "timestamp");
        const auto time_us = number(time);
        const auto time_ns = time_us ? log_time_ns(*time_us, 1e3) : std::nullopt;
        if (time_ns) selections_.push_back({*time_ns, *device});
    }
    const auto device = device_of(subscription.status_device);
    const auto temperature = number(subscription.status_temperature);
    if (device && temperature) temperature_c_[*device] = *temperature;
}

void UlogLog::note_dropout(Bytes content)
{
    if (content.size() < 2) return;
    ++dropouts_;
    dropout_ms_ += little_endian<std::uint16_t>(content);
    if (!dropout_remark_) {
        dropout_remark_ = remarks_.size();
        remarks_.emplace_back();
    }
    remarks_[*dropout_remark_] =
        fmt::format("the logger was too slow and dropped {} ms in {} dropout{}", dropout_ms_, dropouts_, dropouts_ == 1 ? "" : "s");
}

/// Passes over what is no message to the next synchronisation message.
ReadOutcome UlogLog::resynchronise()
{
    ++statistics_.records;
    ++statistics_.malformed;
    input_.take(1);
    for (Bytes bytes = input_.peek(sync.size()); bytes.size() >= sync.size(); bytes = input_.peek(sync.size())) {
        const auto found = std::search(bytes.begin(), bytes.end(), sync.begin(), sync.end());
        if (found != bytes.end()) {
            input_.take(static_cast<std::size_t>(found - bytes.begin()));
            break;
        }
        input_.take(bytes.size() - (sync.size() - 1));
    }
    if (const std::size_t left = input_.peek(sync.size()).size(); left < sync.size()) input_.take(left);
    const std::uint64_t passed = input_.offset() - record_;
    statistics_.skipped_bytes += passed;
    return refuse(fmt::format("no message starts here; {} bytes passed over", passed));
}

ReadOutcome UlogLog::end_of(std::size_t left)
{
    if (ended_) return ReadOutcome::end;
    ended_ = true;
    input_.take(left);
    statistics_.truncated_bytes += left;
    if (!input_.trouble().empty()) return refuse(input_.trouble());
    if (left > 0) return refuse(fmt::format("the log ends {} bytes into a message", left));
    return ReadOutcome::end;
}

ReadOutcome UlogLog::refuse(std::string_view why)
{
    problem_ = fmt::format("{}: byte {}: {}", name_, record_, why);
    return ReadOutcome::rejected;
}

}  // namespace quorient::recording::ulog
