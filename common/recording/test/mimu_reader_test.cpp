#include "log_files.hpp"
#include "quorient/messages/codes.hpp"

#include <gmock/gmock.h>
#include <numbers>
#include <random>

namespace quorient::recording {
namespace {

using testing::HasSubstr;
using Bytes = std::vector<std::uint8_t>;

constexpr std::size_t packet_size = 106;
constexpr double degree = std::numbers::pi / 180.0;

class MimuReader : public LogFiles {};

/// A packet as the format page says: every gyro code = 100 * imu + axis, every accelerometer code its negative.
Bytes packet(std::uint16_t number, std::uint32_t ticks)
{
    Bytes bytes;
    const auto put16 = [&](unsigned value) {
        bytes.push_back(static_cast<std::uint8_t>(value >> 8U & 0xFFU));
        bytes.push_back(static_cast<std::uint8_t>(value & 0xFFU));
    };
    bytes.push_back(0xAA);
    put16(number);
    bytes.push_back(100);
    put16(ticks >> 16U);
    put16(ticks & 0xFFFFU);
    for (int imu = 1; imu <= 8; ++imu) {
        for (int k = 0; k < 3; ++k) put16(static_cast<unsigned>(-(100 * imu + k)));
        for (int k = 0; k < 3; ++k) put16(static_cast<unsigned>(100 * imu + k));
    }
    unsigned sum = 0;
    for (const auto byte : bytes) sum += byte;
    put16(sum & 0xFFFFU);
    return bytes;
}

Bytes log_of(int packets, std::uint16_t first_number = 65530, std::uint32_t first_ticks = 0xFFFF0000U)
{
    Bytes bytes{0xA0, 0x28, 0x00, 0xC8};
    for (int i = 0; i < packets; ++i) {
        const auto one = packet(static_cast<std::uint16_t>(first_number + i), first_ticks + static_cast<std::uint32_t>(i) * 1'024'000U);
        bytes.insert(bytes.end(), one.begin(), one.end());
    }
    return bytes;
}

std::size_t offset_of(int packet_index)
{
    return 4 + packet_size * static_cast<std::size_t>(packet_index);
}

TEST_F(MimuReader, turns_codes_into_increments_across_counter_and_clock_overflow)
{
    const Log log = read_all(write("good.bin", log_of(20)));
    expect_orderly(log);
    ASSERT_EQ(log.frames.size(), 20U);
    EXPECT_TRUE(log.problems.empty());
    EXPECT_EQ(log.statistics.lost, 0U);
    EXPECT_EQ(log.statistics.duration_ns, 19 * 16'000'000);
    const RecordedFrame& frame = log.frames[9];
    EXPECT_EQ(frame.axis_count, 24U);
    EXPECT_EQ(frame.valid_mask, all_axes(24));
    EXPECT_EQ(frame.time_ns, 10 * 16'000'000);
    EXPECT_DOUBLE_EQ(frame.interval_s, 0.016);
    EXPECT_EQ(frame.position, offset_of(9));
    EXPECT_EQ(frame.lost_before, 0U);
    EXPECT_DOUBLE_EQ(frame.increment[3 * 4 + 2], 502 / 16.4 * degree * 0.016);  // IMU5, z
    EXPECT_DOUBLE_EQ(frame.acceleration_m_s2[3 * 4 + 2], -502 / 2048.0 * 9.80665);
}

TEST_F(MimuReader, knows_how_the_imus_are_mounted)
{
    const auto reader = open_log(write("good.bin", log_of(20)));
    ASSERT_TRUE(reader) << reader.error();
    const ClusterDescription& board = (*reader)->description();
    EXPECT_EQ(board.axis_count, 24);
    EXPECT_EQ(board.instrument_count, 8);
    EXPECT_STREQ(board.instrument_name[2].data(), "IMU3");
    EXPECT_EQ(board.instrument[8], 2);
    EXPECT_EQ(board.axis[7], (std::array<double, 3>{0, 1, 0}));   // IMU3 as the body
    EXPECT_EQ(board.axis[3], (std::array<double, 3>{0, -1, 0}));  // IMU2 flipped: its x sees -y of the body
    EXPECT_EQ(board.axis[5], (std::array<double, 3>{0, 0, -1}));
    EXPECT_DOUBLE_EQ(board.interval_s, 0.016);
    EXPECT_NEAR(board.range[0], 2000 * degree, 1e-12);
}

TEST_F(MimuReader, passes_over_a_packet_with_a_broken_checksum)
{
    Bytes bytes = log_of(20);
    bytes[offset_of(7) + 50] ^= 0x01U;
    const Log log = read_all(write("broken.bin", bytes));
    expect_orderly(log);
    EXPECT_EQ(log.statistics.checksum_failures, 1U);
    EXPECT_EQ(log.statistics.lost, 0U) << "the broken packet is counted as broken, not as lost";
    EXPECT_EQ(log.statistics.skipped_bytes, packet_size);
    ASSERT_EQ(log.frames.size(), 19U);
    EXPECT_EQ(log.frames[7].lost_before, 1U);
    EXPECT_EQ(log.frames[7].time_ns, 9 * 16'000'000);
    EXPECT_DOUBLE_EQ(log.frames[7].interval_s, 0.016);
    ASSERT_EQ(log.problems.size(), 1U);
    EXPECT_THAT(log.problems[0], AllOf(HasSubstr("broken.bin: byte " + std::to_string(offset_of(7))), HasSubstr("checksum")));
}

TEST_F(MimuReader, finds_the_next_packet_after_lost_and_foreign_bytes)
{
    Bytes bytes = log_of(20);
    const Bytes garbage{0xAA, 1, 2, 100, 0xAA, 0xAA, 7};
    bytes.erase(bytes.begin() + static_cast<std::ptrdiff_t>(offset_of(12) + 30),
                bytes.begin() + static_cast<std::ptrdiff_t>(offset_of(12) + 47));
    bytes.insert(bytes.begin() + static_cast<std::ptrdiff_t>(offset_of(4)), garbage.begin(), garbage.end());
    const Log log = read_all(write("garbage.bin", bytes));
    expect_orderly(log);
    EXPECT_EQ(log.frames.size(), 19U);
    EXPECT_EQ(log.statistics.skipped_bytes, garbage.size() + packet_size - 17);
    EXPECT_EQ(log.statistics.lost, 0U);
}

TEST_F(MimuReader, counts_packets_that_are_missing)
{
    Bytes bytes = log_of(20);
    bytes.erase(bytes.begin() + static_cast<std::ptrdiff_t>(offset_of(5)), bytes.begin() + static_cast<std::ptrdiff_t>(offset_of(8)));
    const Log log = read_all(write("gap.bin", bytes));
    expect_orderly(log);
    EXPECT_TRUE(log.problems.empty());
    ASSERT_EQ(log.frames.size(), 17U);
    EXPECT_EQ(log.statistics.lost, 3U);
    EXPECT_EQ(log.frames[5].lost_before, 3U);
    EXPECT_EQ(log.frames[5].time_ns, 9 * 16'000'000);
    EXPECT_DOUBLE_EQ(log.frames[5].interval_s, 0.016);
}

TEST_F(MimuReader, refuses_a_packet_that_comes_twice)
{
    Bytes bytes = log_of(20);
    const Bytes again(bytes.begin() + static_cast<std::ptrdiff_t>(offset_of(5)), bytes.begin() + static_cast<std::ptrdiff_t>(offset_of(6)));
    bytes.insert(bytes.begin() + static_cast<std::ptrdiff_t>(offset_of(6)), again.begin(), again.end());
    const Log log = read_all(write("twice.bin", bytes));
    expect_orderly(log);
    EXPECT_EQ(log.frames.size(), 20U);
    EXPECT_EQ(log.statistics.repeated, 1U);
    EXPECT_EQ(log.statistics.lost, 0U);
}

TEST_F(MimuReader, goes_on_after_its_clock_jumped_back)
{
    Bytes bytes = log_of(10, 0, 100'000'000);
    const Bytes rest = log_of(10, 10, 5'000'000);
    bytes.insert(bytes.end(), rest.begin() + 4, rest.end());
    const Log log = read_all(write("jump.bin", bytes));
    expect_orderly(log);
    EXPECT_EQ(log.statistics.irregular, 1U);
    ASSERT_EQ(log.frames.size(), 19U);
    EXPECT_EQ(log.frames[10].lost_before, 1U);
    EXPECT_EQ(log.frames.back().time_ns, 20 * 16'000'000);
}

TEST_F(MimuReader, says_where_a_truncated_log_ends)
{
    Bytes bytes = log_of(20);
    bytes.resize(bytes.size() - 40);
    const Log log = read_all(write("cut.bin", bytes));
    expect_orderly(log);
    EXPECT_EQ(log.frames.size(), 19U);
    EXPECT_EQ(log.statistics.truncated_bytes, packet_size - 40);
    ASSERT_EQ(log.problems.size(), 1U);
    EXPECT_THAT(log.problems[0], HasSubstr("byte " + std::to_string(offset_of(19))));
}

TEST_F(MimuReader, names_a_swapped_byte_order)
{
    Bytes words = log_of(20);
    for (std::size_t i = 0; i + 1 < words.size(); i += 2) std::swap(words[i], words[i + 1]);
    EXPECT_THAT(open_log(write("words.bin", words)).error(), HasSubstr("byte order"));

    Bytes fields = log_of(20);
    for (int i = 0; i < 20; ++i) std::swap(fields[offset_of(i) + 104], fields[offset_of(i) + 105]);
    EXPECT_THAT(open_log(write("fields.bin", fields)).error(), HasSubstr("byte order"));
}

TEST_F(MimuReader, refuses_constant_and_foreign_files_with_the_place)
{
    EXPECT_THAT(open_log(write("zeros.bin", Bytes(5000, 0))).error(), AllOf(HasSubstr("zeros.bin"), HasSubstr("byte 0")));
    EXPECT_THAT(open_log(write("ones.bin", Bytes(5000, 0xAA))).error(), HasSubstr("byte 0"));
    EXPECT_THAT(open_log(write("empty.bin", Bytes{})).error(), HasSubstr("empty"));
    EXPECT_THAT(open_log("/nowhere/log.bin").error(), HasSubstr("/nowhere/log.bin"));
    EXPECT_FALSE(open_log("/"));
}

TEST_F(MimuReader, survives_any_damage)
{
    const unsigned seed = 20240612;
    std::mt19937 random(seed);
    for (int trial = 0; trial < 300; ++trial) {
        Bytes bytes = log_of(30);
        for (auto hit = random() % 20; hit > 0; --hit) bytes[random() % bytes.size()] = static_cast<std::uint8_t>(random());
        if (random() % 2 == 0)
            bytes.erase(bytes.begin() + static_cast<std::ptrdiff_t>(random() % 500),
                        bytes.begin() + 500 + static_cast<std::ptrdiff_t>(random() % 500));
        bytes.resize(bytes.size() - random() % 200);
        const auto reader = open_log(write("damaged.bin", bytes));
        if (!reader) continue;
        SCOPED_TRACE(testing::Message() << "seed " << seed << " trial " << trial);
        const Log log = read_all(**reader);
        expect_orderly(log);
        EXPECT_LE(log.frames.size(), 30U);
    }
}

struct Recording {
    const char* folder;
    std::uint64_t packets;
    double duration_s;
};

TEST(MimuRecording, is_read_without_a_single_loss)
{
    if (!std::filesystem::exists(data_dir() / "mimu4444_carlsson")) GTEST_SKIP() << "no recordings under " << data_dir();
    for (const auto& [folder, packets, duration_s] : {Recording{"exp_1", 37439, 599.0}, Recording{"exp_2", 39301, 628.8}}) {
        const Log log = read_all(data_dir() / "mimu4444_carlsson" / folder / "data.bin");
        expect_orderly(log);
        EXPECT_EQ(log.statistics.records, packets) << folder;
        EXPECT_EQ(log.statistics.frames, packets) << folder;
        EXPECT_NEAR(static_cast<double>(log.statistics.duration_ns) * 1e-9, duration_s, 0.05) << folder;
        EXPECT_EQ(log.statistics.checksum_failures, 0U) << folder;
        EXPECT_EQ(log.statistics.lost, 0U) << folder;
    }
}

TEST(MimuRecording, shows_gravity_the_same_in_all_imus_as_mounted)
{
    const auto file = data_dir() / "mimu4444_carlsson" / "exp_1" / "data.bin";
    if (!std::filesystem::exists(file)) GTEST_SKIP() << "no recordings under " << data_dir();
    const auto reader = open_log(file);
    ASSERT_TRUE(reader) << reader.error();
    const auto& axis = (*reader)->description().axis;
    RecordedFrame frame;
    ASSERT_EQ((*reader)->next(frame), ReadOutcome::frame);
    std::array<double, 3> first{};
    for (std::size_t imu = 0; imu < 8; ++imu) {
        std::array<double, 3> body{};
        for (std::size_t k = 0; k < 3; ++k)
            for (std::size_t i = 0; i < 3; ++i) body[i] += axis[3 * imu + k][i] * frame.acceleration_m_s2[3 * imu + k];
        if (imu == 0) first = body;
        for (std::size_t i = 0; i < 3; ++i) EXPECT_NEAR(body[i], first[i], 1.2) << "IMU" << imu + 1;  // uncalibrated: 0.1 g of bias
    }
}

}  // namespace
}  // namespace quorient::recording
