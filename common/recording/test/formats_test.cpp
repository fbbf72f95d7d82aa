#include "bytes/byte_source.hpp"
#include "instrument_log_test.hpp"
#include "writers/dataflash_writer.hpp"

#include <gmock/gmock.h>
#include <lz4frame.h>
#include <zlib.h>
#include <zstd.h>

namespace quorient::recording {
namespace {

using testing::HasSubstr;

using ByteVector = std::vector<std::uint8_t>;

ByteVector gzipped(const ByteVector& plain)
{
    z_stream stream{};
    deflateInit2(&stream, 6, Z_DEFLATED, 15 + 16, 8, Z_DEFAULT_STRATEGY);
    ByteVector packed(deflateBound(&stream, plain.size()) + 64);
    stream.next_in = const_cast<Bytef*>(plain.data());
    stream.avail_in = static_cast<uInt>(plain.size());
    stream.next_out = packed.data();
    stream.avail_out = static_cast<uInt>(packed.size());
    deflate(&stream, Z_FINISH);
    packed.resize(stream.total_out);
    deflateEnd(&stream);
    return packed;
}

ByteVector zstd_packed(const ByteVector& plain)
{
    ByteVector packed(ZSTD_compressBound(plain.size()));
    packed.resize(ZSTD_compress(packed.data(), packed.size(), plain.data(), plain.size(), 3));
    return packed;
}

ByteVector lz4_packed(const ByteVector& plain)
{
    ByteVector packed(LZ4F_compressFrameBound(plain.size(), nullptr));
    packed.resize(LZ4F_compressFrame(packed.data(), packed.size(), plain.data(), plain.size(), nullptr));
    return packed;
}

TEST(CompressedLogs, read_as_what_they_hold)
{
    const ByteVector plain = test::dataflash_of_three_imus(2000);
    const Samples expected = samples_of(plain);
    ByteVector two_members = gzipped(ByteVector(plain.begin(), plain.begin() + 50'000));
    const ByteVector second = gzipped(ByteVector(plain.begin() + 50'000, plain.end()));
    two_members.insert(two_members.end(), second.begin(), second.end());
    for (const ByteVector& packed : {gzipped(plain), zstd_packed(plain), lz4_packed(plain), two_members}) {
        ASSERT_LT(packed.size(), plain.size());
        const Samples log = samples_of(packed);
        ASSERT_EQ(log.samples.size(), expected.samples.size());
        EXPECT_EQ(log.samples.back().time_ns, expected.samples.back().time_ns);
        EXPECT_EQ(log.samples.back().position, expected.samples.back().position);
        EXPECT_TRUE(log.problems.empty());
    }
}

TEST(CompressedLogs, say_where_they_are_cut_or_damaged)
{
    const ByteVector plain = test::dataflash_of_three_imus(2000);
    for (ByteVector packed : {gzipped(plain), zstd_packed(plain), lz4_packed(plain)}) {
        packed.resize(packed.size() * 2 / 3);
        const Samples log = samples_of(packed);
        ASSERT_FALSE(log.problems.empty());
        EXPECT_THAT(log.problems.back(), HasSubstr("cut at its byte"));
        EXPECT_GT(log.samples.size(), 100U);
    }
    ByteVector damaged = gzipped(plain);
    for (std::size_t i = damaged.size() / 2; i < damaged.size() / 2 + 40; ++i) damaged[i] ^= 0x55U;
    const Samples log = samples_of(damaged);
    ASSERT_FALSE(log.problems.empty());
    EXPECT_THAT(log.problems.back(), HasSubstr("gzip"));
}

TEST(CompressedLogs, hold_a_bounded_buffer_and_begin_again)
{
    const ByteVector plain(3'000'000, 'x');
    auto source = decompressed(memory_source(gzipped(plain)));
    ByteVector part(1'000'000);
    for (int turn = 0; turn < 2; ++turn) {
        std::size_t total = 0;
        for (std::size_t count = source->read(part); count > 0; count = source->read(part)) total += count;
        EXPECT_EQ(total, plain.size());
        EXPECT_EQ(source->progress(), 1.0);
        source->rewind();
    }
}

TEST(Formats, that_cannot_be_read_are_named_with_what_converts_them)
{
    EXPECT_THAT(refusal_of("H Product:Blackbox flight data recorder by Nicholas Sherlock\nH Data version:2\n"), HasSubstr("blackbox_decode"));
    EXPECT_THAT(refusal_of("#ROSBAG V2.0\n\x45\x01\x01"), HasSubstr("mcap convert"));
    EXPECT_THAT(refusal_of("PK\x03\x04 spreadsheet"), HasSubstr("CSV"));
    EXPECT_THAT(refusal_of(std::string("\xFF\xFEt\0i\0m\0e\0", 10)), HasSubstr("UTF-8"));
    EXPECT_THAT(refusal_of(""), HasSubstr("empty"));
    EXPECT_THAT(refusal_of(std::string("\x01\x02\x03\0\x04", 5)), AllOf(HasSubstr("no known log"), HasSubstr("DataFlash"), HasSubstr("ULog")));
    std::string telemetry;
    for (int i = 0; i < 3; ++i) telemetry += std::string("\0\x05\x8A\x01\x02\x03\x04\x05\xFE\x02\x01\x01\x01\x1Bxxcc", 18);
    EXPECT_THAT(refusal_of(telemetry), HasSubstr("mavlogdump"));
}

TEST(Formats, are_told_by_content_and_not_by_name)
{
    EXPECT_EQ(samples_of(test::dataflash_of_three_imus(3), {}, "renamed.csv").format, "ArduPilot DataFlash");
    EXPECT_EQ(samples_of(std::string("t_s,gx_dps,gy_dps,gz_dps\n1,1,2,3\n1.01,1,2,3\n"), {}, "table.bin").format, "CSV");
    EXPECT_THAT(open_instruments("/nonexistent/log").error(), HasSubstr("/nonexistent/log"));
}

TEST(Formats, have_the_recordings_of_before_as_instruments)
{
    const auto file = data_dir() / "mimu4444_carlsson" / "exp_1" / "data.bin";
    if (!std::filesystem::exists(file)) GTEST_SKIP() << "no recording " << file;
    const Samples log = samples_of(open_instruments(file));
    EXPECT_THAT(log.names(), testing::ElementsAre("IMU1", "IMU2", "IMU3", "IMU4", "IMU5", "IMU6", "IMU7", "IMU8"));
    EXPECT_EQ(log.instruments[1].axis[0], (std::array<double, 3>{0, -1, 0}));
    const auto frames = read_all(file);
    EXPECT_EQ(log.samples.size(), 8 * frames.frames.size());
    EXPECT_NEAR(log.samples[8 * 100 + 3].rate_rad_s[1], frames.frames[100].increment[10] / frames.frames[100].interval_s, 1e-15);
}

}  // namespace
}  // namespace quorient::recording
