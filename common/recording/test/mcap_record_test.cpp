// Records of Quorient itself: what the writer wrote is read back bit for bit, whatever happened to the file.

#include "mcap/frame_reader.hpp"
#include "quorient/recording/merge.hpp"
#include "writers/record_writer.hpp"
#include "instrument_log_test.hpp"

#include <gmock/gmock.h>
#include <cmath>
#include <cstring>
#include <functional>

namespace quorient::recording {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using test::ByteVector;
using test::cdr_of;
using test::description_of;
using test::frame_of;
using test::frames_of;
using test::Record;
using test::record_of;
using test::truth_of;

struct Opened {
    std::unique_ptr<mcap::FrameReader> reader;
    Log log;
};

auto open(ByteVector bytes)
{
    Input input(memory_source(std::move(bytes)));
    return mcap::FrameReader::open(input, "record.mcap");
}

Opened read(ByteVector bytes)
{
    auto opened = open(std::move(bytes));
    if (!opened || !*opened) {
        ADD_FAILURE() << (opened ? opened->error() : "no record of Quorient");
        return {};
    }
    Opened result{std::move(**opened), {}};
    result.log = read_all(*result.reader);
    return result;
}

/// Bits, not values: -0 is not 0 here.
void expect_same(const RecordedFrame& read, const SensorFrame& written)
{
    EXPECT_EQ(std::memcmp(read.increment.data(), written.increment.data(), written.axis_count * sizeof(double)), 0) << "frame " << written.sequence;
    EXPECT_EQ(std::memcmp(&read.interval_s, &written.interval_s, sizeof(double)), 0) << "frame " << written.sequence;
    EXPECT_EQ(read.valid_mask, written.valid_mask);
    EXPECT_EQ(read.axis_count, written.axis_count);
    EXPECT_EQ(read.time_ns, written.sample_time_ns);
}

void expect_same(const std::vector<RecordedFrame>& read, const std::vector<SensorFrame>& written)
{
    ASSERT_EQ(read.size(), written.size());
    for (std::size_t i = 0; i < read.size(); ++i) expect_same(read[i], written[i]);
}

TEST(McapRecord, gives_frames_bit_for_bit_and_the_description)
{
    auto frames = frames_of(1000);
    frames[3].increment[1] = -0.0;
    const auto [reader, log] = read(record_of(frames));
    expect_same(log.frames, frames);
    EXPECT_TRUE(log.problems.empty());
    const auto& description = reader->description();
    EXPECT_EQ(description.sigma[2], 1e-6);
    EXPECT_EQ(description.axis[0][0], 1);
    EXPECT_EQ(description.bias[1], 0) << "the publisher has subtracted it";
    EXPECT_EQ(description.initial_attitude_known, octet(InitialAttitude::measured));
    EXPECT_EQ(summary(reader->statistics()), "1000 records, 1000 frames, 5.0 s");
}

TEST(McapRecord, knows_no_initial_attitude_where_it_begins_later)
{
    const std::vector<SensorFrame> later{frame_of(7), frame_of(8)};
    const auto [reader, log] = read(record_of(later));
    EXPECT_EQ(reader->description().initial_attitude_known, octet(InitialAttitude::unknown));
    EXPECT_EQ(log.frames.size(), 2U);
    EXPECT_EQ(log.frames[0].time_ns, 5'000'000) << "counted from the first frame's beginning";
}

TEST(McapRecord, gives_each_frame_its_truth_wherever_it_stands)
{
    const auto frames = frames_of(100);
    Record record;
    for (std::size_t i = 0; i < 50; ++i) record.add(truth_of(frames[i]));
    for (std::size_t i = 0; i < 50; ++i) record.add(frames[i]);
    for (std::size_t i = 50; i < 100; ++i) record.add(frames[i]);
    record.add(description_of(4));
    for (std::size_t i = 50; i < 100; ++i)
        if (i != 60) record.add(truth_of(frames[i]));
    const auto [reader, log] = read(record.finish());
    expect_same(log.frames, frames);
    for (std::size_t i = 0; i < 100; ++i) {
        ASSERT_EQ(log.frames[i].truth.has_value(), i != 60) << i;
        EXPECT_EQ(i == 60 || (*log.frames[i].truth)[3] == static_cast<double>(i), true) << i;
    }
    EXPECT_EQ(reader->description().axis[0][0], 1) << "a description behind the first frame";
}

TEST(McapRecord, of_which_any_end_is_missing_gives_all_whole_chunks)
{
    const auto frames = frames_of(500);
    const auto bytes = record_of(frames, 50);
    std::size_t most = 0;
    for (std::size_t size = 0; size < bytes.size(); size += 97) {
        auto opened = open({bytes.begin(), bytes.begin() + static_cast<std::ptrdiff_t>(size)});
        if (!opened || !*opened) {
            EXPECT_EQ(most, 0U) << "nothing is read of " << size << " bytes, and was of fewer";
            continue;
        }
        const Log log = read_all(***opened);
        EXPECT_GE(log.frames.size(), most);
        most = log.frames.size();
        for (std::size_t i = 0; i < most; ++i) expect_same(log.frames[i], frames[i]);
    }
    EXPECT_EQ(most, 500U);
}

TEST(McapRecord, is_whole_up_to_the_chunk_that_was_written_last)
{
    Record record;
    record.add(description_of(4));
    for (std::uint64_t i = 0; i < 20; ++i) record.add(frame_of(i));
    record.end_chunk();
    for (std::uint64_t i = 20; i < 30; ++i) record.add(frame_of(i));
    const auto [reader, log] = read(record.bytes());
    EXPECT_EQ(log.frames.size(), 20U);
    EXPECT_TRUE(log.problems.empty());
    EXPECT_EQ(record.writer().written(), 21U);
    EXPECT_EQ(record.writer().intact_size(), record.bytes().size());
}

TEST(McapRecord, is_read_from_what_another_tool_made_of_it)
{
    const auto frames = frames_of(200);
    for (const char* const compression : {"unchunked", "", "zstd", "lz4"}) {
        SCOPED_TRACE(compression);
        const bool chunked = std::string(compression) != "unchunked";
        test::McapWriter other;
        test::Bytes records;
        const auto flush = [&] {
            if (chunked) other.chunk(records, compression);
            else other.log.put(std::string(records.data.begin(), records.data.end()));
            records = {};
        };
        for (std::size_t i = 0; i < frames.size(); ++i) {
            if (i % 30 == 0) {  // in each chunk again, under other numbers than ours
                test::McapWriter::schema(records, 9, "quorient_msgs::SensorFrame", "omgidl");
                test::McapWriter::channel(records, 77, 9, "quorient/frame");
            }
            test::McapWriter::message(records, 77, i, cdr_of(frames[i]));
            if (i % 30 == 29) flush();
        }
        flush();
        other.finish();
        const auto [reader, log] = read(other.log.data);
        expect_same(log.frames, frames);
        EXPECT_TRUE(log.problems.empty());
    }
}

TEST(McapRecord, in_an_unknown_compression_is_refused_with_its_name)
{
    for (const bool names_outside : {true, false}) {
        test::Bytes records;
        test::McapWriter other;
        test::Bytes& names = names_outside ? other.log : records;
        test::McapWriter::schema(names, 9, "quorient_msgs::SensorFrame", "omgidl");
        test::McapWriter::channel(names, 77, 9, "quorient/frame");
        test::McapWriter::message(records, 77, 0, cdr_of(frame_of(0)));
        other.chunk(records, "brotli");
        other.finish();
        auto opened = open(other.log.data);
        ASSERT_TRUE(opened);
        ASSERT_FALSE(*opened);
        EXPECT_THAT(opened->error(), HasSubstr("record.mcap: byte"));
        EXPECT_THAT(opened->error(), HasSubstr("compressed by 'brotli'"));
    }
}

TEST(McapRecord, counts_frames_that_are_missing_and_passes_over_those_of_others)
{
    Record record;
    record.add(description_of(4));
    record.add(frame_of(0));
    auto other_unit = frame_of(1);
    other_unit.unit = 2;
    record.add(other_unit);
    record.add(frame_of(4));
    const auto [reader, log] = read(record.finish());
    ASSERT_EQ(log.frames.size(), 2U);
    EXPECT_EQ(log.frames[1].lost_before, 3U);
    EXPECT_EQ(reader->statistics().lost, 3U);
    EXPECT_TRUE(log.problems.empty());
}

TEST(McapRecord, refuses_what_does_not_continue_the_frames_before)
{
    struct Case {
        std::function<void(SensorFrame&)> spoil;
        const char* why;
    };
    const std::vector<Case> cases{
        {[](SensorFrame& frame) { frame.epoch = test::epoch + 1; }, "another epoch"},
        {[](SensorFrame& frame) { frame.sequence = 0; }, "frame 0 after 0"},
        {[](SensorFrame& frame) { frame.sample_time_ns = 0; }, "does not go forward"},
        {[](SensorFrame& frame) { frame.axis_count = 25; }, "impossible"},
        {[](SensorFrame& frame) { frame.axis_count = 3; }, "impossible"},
        {[](SensorFrame& frame) { frame.interval_s = -1; }, "impossible"},
        {[](SensorFrame& frame) { frame.increment.fill(std::nan("")); }, "no axis has a finite value"},
        {[](SensorFrame& frame) { frame.valid_mask = 0; }, "no axis has a finite value"},
        {[](SensorFrame& frame) { frame.sequence = std::uint64_t{1} << 50U; }, "more than an hour"},
    };
    for (const Case& one : cases) {
        SCOPED_TRACE(one.why);
        Record record;
        record.add(description_of(4));
        record.add(frame_of(0));
        auto spoiled = frame_of(1);
        one.spoil(spoiled);
        record.add(spoiled);
        record.add(frame_of(2));
        const auto [reader, log] = read(record.finish());
        ASSERT_FALSE(log.problems.empty());
        EXPECT_THAT(log.problems.front(), HasSubstr(one.why));
        EXPECT_EQ(log.frames.front().time_ns, 5'000'000);
    }
}

TEST(McapRecord, leaves_out_an_axis_without_a_finite_value_and_refuses_other_byte_orders)
{
    Record record;
    record.add(description_of(4));
    auto frame = frame_of(0);
    frame.increment[2] = std::nan("");
    record.add(frame);
    auto big_endian = cdr_of(frame_of(1));
    big_endian[1] = 0;
    record.add_raw_frame(big_endian);
    record.add_raw_frame(ByteVector(12, 1));
    const auto [reader, log] = read(record.finish());
    ASSERT_EQ(log.frames.size(), 1U);
    EXPECT_EQ(log.frames[0].valid_mask, 0b1011U);
    EXPECT_EQ(log.frames[0].increment[2], 0.0);
    EXPECT_EQ(reader->statistics().incomplete, 1U);
    EXPECT_EQ(reader->statistics().malformed, 2U);
    EXPECT_EQ(log.problems.size(), 2U);
}

TEST(McapRecord, is_not_seen_in_a_bag_of_ros)
{
    EXPECT_FALSE(open(test::mcap_of_two_imus(20, "zstd")));
    Record without_frames;
    without_frames.add(description_of(4));
    const auto opened = open(without_frames.finish());
    ASSERT_TRUE(opened);
    ASSERT_FALSE(*opened);
    EXPECT_THAT(opened->error(), HasSubstr("no frame of gyros"));
}

TEST(McapRecord, of_triads_is_a_log_of_instruments_and_of_single_axes_none)
{
    auto description = description_of(6);
    description.instrument_count = 2;
    for (std::uint8_t axis = 0; axis < 6; ++axis) description.instrument[axis] = axis / 3;
    auto frame = frame_of(0);
    frame.axis_count = 6;
    frame.valid_mask = 0b111111;
    Record record;
    record.add(description);
    record.add(frame);
    const auto samples = samples_of(record.finish());
    EXPECT_EQ(samples.format, "Quorient's record");
    ASSERT_EQ(samples.samples.size(), 2U);
    EXPECT_EQ(samples.samples[1].rate_rad_s[0], frame.increment[3] / frame.interval_s);
    const auto refused = open_instruments(record_of(frames_of(3)), "record.mcap");
    ASSERT_FALSE(refused);
    EXPECT_THAT(refused.error(), HasSubstr("4 single axes"));
}

class McapRecordFile : public LogFiles {};

TEST_F(McapRecordFile, is_opened_as_a_log_of_frames)
{
    const auto frames = frames_of(30);
    const auto file = write("record.mcap", record_of(frames));
    const auto reader = open_log(file);
    ASSERT_TRUE(reader) << reader.error();
    expect_same(read_all(**reader).frames, frames);
}

TEST_F(McapRecordFile, of_several_is_one_log_whatever_the_order_of_their_names)
{
    const auto frames = frames_of(90);
    const auto part = [&](std::size_t begin, std::size_t end) {
        return record_of({frames.begin() + static_cast<std::ptrdiff_t>(begin), frames.begin() + static_cast<std::ptrdiff_t>(end)});
    };
    const std::vector<std::filesystem::path> files{write("b.mcap", part(62, 90)), write("a.mcap", part(0, 30)), write("c.mcap", part(29, 60))};
    const auto merged = open_logs(files);
    ASSERT_TRUE(merged) << merged.error();
    auto expected = frames;
    expected.erase(expected.begin() + 60, expected.begin() + 62);
    const Log log = read_all(*merged->reader);
    expect_same(log.frames, expected);
    EXPECT_EQ(log.frames[60].lost_before, 2U) << "missing between two files";
    EXPECT_EQ(merged->reader->statistics().lost, 2U);
    EXPECT_EQ(merged->reader->description().axis[0][0], 1);

    auto restarted = frame_of(0);
    restarted.epoch += 1;
    auto description = description_of(4);
    description.epoch += 1;
    Record other;
    other.add(description);
    other.add(restarted);
    EXPECT_FALSE(open_logs(std::vector{files[1], write("other.mcap", other.finish())})) << "another epoch does not continue the first";
}

}  // namespace
}  // namespace quorient::recording
