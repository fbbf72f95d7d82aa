#include "mcap_file.hpp"

#include "quorient/runtime/options.hpp"
#include "schemas.hpp"

#include <fmt/format.h>
#include <cassert>
#include <cstring>

namespace quorient::record {

namespace {

using Clock = std::chrono::steady_clock;

constexpr std::size_t encapsulation = 4;  // bytes in front of a sample
constexpr auto flush_period = std::chrono::seconds{1};

template <class Message>
Message sample_in(std::span<const std::uint8_t> cdr)
{
    Message message;
    assert(cdr.size() == encapsulation + sizeof message);
    std::memcpy(&message, cdr.data() + encapsulation, sizeof message);
    return message;
}

std::span<const std::uint8_t> bytes_of(const std::string& text)
{
    return {reinterpret_cast<const std::uint8_t*>(text.data()), text.size()};
}

}  // namespace

McapFile::McapFile(const std::string& name, bool force)
    : output_(name, force), writer_(output_.stream(), fmt::format("quorient {}", runtime::version())), opened_(Clock::now()), flushed_(opened_)
{
    add_channels();
}

void McapFile::add_channels()
{
    const auto add = [&](std::string_view topic, const Schema& schema) {
        return writer_.add_channel(topic, schema.message_encoding, writer_.add_schema(schema.name, schema.encoding, schema.text));
    };
    const auto add_topic = [&](const auto& topic) {
        [[maybe_unused]] const auto channel = add(topic.spec.name, contract_schema(topic.spec.type));
        assert(channel == channel_of(topic.spec.type));
    };
    std::apply([&](const auto&... topic) { (add_topic(topic), ...); }, bus::topics::all);
    transform_channel_ = add("/attitude/transform", transform_schema());
    imu_channel_ = add("/imu/data", imu_schema());
}

void McapFile::add(std::uint16_t channel, std::uint64_t log_time_ns, std::span<const std::uint8_t> cdr)
{
    writer_.add(channel, log_time_ns, cdr);
    if (channel == channel_of(bus::TypeId::cluster_description)) viewers_.describe(sample_in<ClusterDescription>(cdr));
    if (channel == channel_of(bus::TypeId::voted_attitude)) add_viewer_messages(log_time_ns, cdr);
}

void McapFile::add_viewer_messages(std::uint64_t log_time_ns, std::span<const std::uint8_t> voted_cdr)
{
    viewers_.make(sample_in<VotedAttitude>(voted_cdr), log_time_ns);
    writer_.add(imu_channel_, log_time_ns, viewers_.imu());
    if (!viewers_.transform().empty()) writer_.add(transform_channel_, log_time_ns, bytes_of(viewers_.transform()));
}

void McapFile::flush_when_due()
{
    const auto now = Clock::now();
    if (now - flushed_ < flush_period) return;
    writer_.end_chunk();
    flushed_ = now;
}

bool McapFile::finish()
{
    if (failure().empty()) writer_.finish();
    try {
        if (!failure().empty()) {
            output_.keep_first(writer_.intact_size());
            cli::fail(fmt::format("{}: {}; the first {} samples are in it, {} of them frames", name(), failure(), samples(), frames()));
        }
        output_.finish();
    } catch (const cli::Exit&) {
        return false;
    } catch (const std::exception&) {  // on the writing thread nobody else catches what even the message could not be written for
        return false;
    }
    return true;
}

std::uint64_t McapFile::frames() const
{
    return writer_.written(channel_of(bus::TypeId::sensor_frame));
}

}  // namespace quorient::record
