#include "mcap/records.hpp"
#include "writers/mcap_writer.hpp"
#include "instrument_log_test.hpp"

#include <gmock/gmock.h>

namespace quorient::recording {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using test::Bytes;
using test::McapWriter;

TEST(Mcap, reads_imus_of_any_topic_from_chunks_compressed_or_not)
{
    for (const char* const compression : {"", "zstd", "lz4"}) {
        SCOPED_TRACE(compression);
        const Samples log = samples_of(test::mcap_of_two_imus(35, compression));
        EXPECT_EQ(log.format, "MCAP");
        EXPECT_THAT(log.names(), ElementsAre("/imu/left", "/imu/right"));
        EXPECT_TRUE(log.problems.empty());
        EXPECT_TRUE(log.remarks.empty());
        ASSERT_EQ(log.of("/imu/right").size(), 35U);
        const InstrumentSample right = log.of("/imu/right")[20];
        EXPECT_EQ(right.time_ns, 100'203'000'000) << "the message's own stamp, not the time of storing";
        EXPECT_THAT(right.rate_rad_s, ElementsAre(0, 0.2, 0)) << "written in the other byte order";
        EXPECT_THAT(right.acceleration_m_s2, ElementsAre(0.1, 0.2, 9.8));
    }
}

TEST(Mcap, reads_messages_outside_of_chunks_and_those_of_ros_1)
{
    McapWriter writer;
    McapWriter::schema(writer.log, 1, "sensor_msgs/Imu", "ros1msg");
    McapWriter::channel(writer.log, 1, 1, "/old", "ros1");
    McapWriter::message(writer.log, 1, 1, test::ros1_imu(7, 5, {1, 2, 3}));
    writer.finish();
    const Samples log = samples_of(writer.log.data);
    ASSERT_EQ(log.samples.size(), 1U);
    EXPECT_EQ(log.samples[0].time_ns, 7'000'000'005);
    EXPECT_THAT(log.samples[0].rate_rad_s, ElementsAre(1, 2, 3));
}

TEST(Mcap, takes_the_time_of_storing_where_a_message_has_no_stamp_and_no_sample_where_it_has_no_rate)
{
    McapWriter writer;
    McapWriter::schema(writer.log, 1, "sensor_msgs/msg/Imu");
    McapWriter::channel(writer.log, 1, 1, "/imu");
    McapWriter::message(writer.log, 1, 42'000, test::cdr_imu(0, 0, {1, 2, 3}));
    McapWriter::message(writer.log, 1, 43'000, test::cdr_imu(5, 0, {1, 2, 3}, "f", true, false));
    McapWriter::message(writer.log, 1, 44'000, test::ByteVector(20, 0));
    writer.finish();
    const Samples log = samples_of(writer.log.data);
    ASSERT_EQ(log.samples.size(), 1U);
    EXPECT_EQ(log.samples[0].time_ns, 42'000);
    EXPECT_EQ(log.statistics.incomplete, 1U);
    EXPECT_THAT(log.problems, ElementsAre(HasSubstr("/imu: not a sensor_msgs/Imu")));
}

TEST(Mcap, gives_nothing_of_a_chunk_that_fails_its_checksum)
{
    Bytes records;
    McapWriter::schema(records, 1, "sensor_msgs/msg/Imu");
    McapWriter::channel(records, 1, 1, "/imu");
    McapWriter::message(records, 1, 1, test::cdr_imu(5, 0, {1, 2, 3}));
    for (const bool sound : {true, false}) {
        McapWriter writer;
        writer.chunk(records, "zstd", sound ? std::nullopt : std::optional<std::uint32_t>(1234));
        writer.finish();
        const Samples log = samples_of(writer.log.data);
        EXPECT_EQ(log.samples.size(), sound ? 1U : 0U);
        EXPECT_EQ(log.statistics.checksum_failures, sound ? 0U : 1U);
    }
    McapWriter unstated;
    unstated.chunk(records, "", 0U);
    unstated.finish();
    EXPECT_EQ(samples_of(unstated.log.data).samples.size(), 1U) << "0 means that no checksum is stated";
}

TEST(Mcap, reads_a_recording_that_was_cut_as_far_as_it_goes)
{
    for (const char* const compression : {"", "zstd", "lz4"}) {
        SCOPED_TRACE(compression);
        auto bytes = test::mcap_of_two_imus(2000, compression);
        bytes.resize(bytes.size() / 2);
        const Samples log = samples_of(bytes);
        EXPECT_GT(log.of("/imu/left").size(), 800U);
        EXPECT_THAT(log.remarks, ElementsAre(HasSubstr("did not end in order")));
        EXPECT_GE(log.problems.size(), 1U);
    }
}

TEST(Mcap, refuses_chunks_that_claim_to_be_endless)
{
    McapWriter writer;
    Bytes content;
    content.put(std::uint64_t{0}).put(std::uint64_t{1}).put(std::uint64_t{1} << 60U).put(std::uint32_t{0});
    test::put_text(content, "");
    content.put(std::uint64_t{4}).put(std::uint32_t{0});
    McapWriter::record(writer.log, 0x06, content);
    writer.finish();
    EXPECT_THAT(samples_of(writer.log.data).problems, ElementsAre(HasSubstr("too large")));
}

TEST(Mcap, records_are_parsed_or_refused)
{
    EXPECT_FALSE(mcap::parse_channel({}));
    EXPECT_FALSE(mcap::parse_schema({}));
    EXPECT_FALSE(mcap::parse_message({}));
    EXPECT_FALSE(mcap::parse_chunk_fields({}));
    Bytes log;
    McapWriter::channel(log, 3, 4, "/t");
    const auto channel = mcap::parse_channel(recording::Bytes(log.data).subspan(mcap::record_header_size));
    ASSERT_TRUE(channel);
    EXPECT_EQ(channel->schema_id, 4);
    EXPECT_EQ(channel->topic, "/t");
    const std::string check = "123456789";  // the check value of CRC-32
    EXPECT_EQ(mcap::crc32(recording::Bytes(reinterpret_cast<const std::uint8_t*>(check.data()), check.size())), 0xCBF43926U);
}

}  // namespace
}  // namespace quorient::recording
