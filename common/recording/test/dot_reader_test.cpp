#include "log_files.hpp"

#include <gmock/gmock.h>
#include <cmath>
#include <numbers>

namespace quorient::recording {
namespace {

using testing::HasSubstr;

constexpr double degree = std::numbers::pi / 180.0;
constexpr std::int64_t step_us = 8333;

class DotReader : public LogFiles {};

std::string header()
{
    return "SampleTimeFine,Euler_X,Euler_Y,Euler_Z,Acc_X,Acc_Y,Acc_Z,Gyr_X,Gyr_Y,Gyr_Z, \n";
}

std::string row(std::int64_t stamp_us, const std::string& values = "0.1,0.2,9.8,10,-20,30")
{
    return std::to_string(stamp_us) + ",0,0,0," + values + ", \n";
}

std::string rows(std::int64_t first_us, int count)
{
    std::string text;
    for (int i = 0; i < count; ++i) text += row((first_us + i * step_us) % 4'294'967'296);
    return text;
}

TEST_F(DotReader, turns_rates_into_increments)
{
    const Log log = read_all(write("Xsens DOT3_ABC.csv", header() + rows(1000, 20)));
    expect_orderly(log);
    EXPECT_TRUE(log.problems.empty());
    ASSERT_EQ(log.frames.size(), 19U) << "the first record only sets the clock";
    const RecordedFrame& frame = log.frames[4];
    EXPECT_DOUBLE_EQ(frame.interval_s, 0.008333);
    EXPECT_EQ(frame.time_ns, 5 * 8'333'000);
    EXPECT_EQ(frame.axis_count, 3U);
    EXPECT_DOUBLE_EQ(frame.increment[1], -20 * degree * 0.008333);
    EXPECT_DOUBLE_EQ(frame.acceleration_m_s2[2], 9.8);
    EXPECT_EQ(frame.acceleration_mask, 0b111U);
    EXPECT_STREQ((*open_log(write("Xsens DOT3_ABC.csv", header() + rows(1000, 20))))->description().instrument_name[0].data(), "DOT3");
}

TEST_F(DotReader, reads_seconds_as_well_and_lines_about_the_device)
{
    const std::string text =
        "sep=,\nDeviceTag:,DOT3\n\ntime,Euler_X,Euler_Y,Euler_Z,Acc_X,Acc_Y,Acc_Z,Gyr_X,Gyr_Y,Gyr_Z\r\n"
        "0.0,0,0,0,1,2,3,4,5,6\r\n0.008333,0,0,0,1,2,3,4,5,6\r\n0.016666,0,0,0,1,2,3,4,5,6\r\n";
    const Log log = read_all(write("IMU_2.csv", text));
    expect_orderly(log);
    ASSERT_EQ(log.frames.size(), 2U);
    EXPECT_DOUBLE_EQ(log.frames[0].increment[2], 6 * degree * 0.008333);
}

TEST_F(DotReader, follows_its_clock_over_the_overflow)
{
    const Log log = read_all(write("wrap.csv", header() + rows(4'294'967'296 - 5 * step_us, 10)));
    expect_orderly(log);
    EXPECT_EQ(log.frames.size(), 9U);
    EXPECT_TRUE(log.problems.empty());
}

TEST_F(DotReader, refuses_what_is_not_finite)
{
    const Log log = read_all(
        write("nan.csv", header() + rows(0, 5) + row(5 * step_us, " NaN, NaN, NaN, Infinity, Infinity, Infinity") + rows(6 * step_us, 5)));
    expect_orderly(log);
    EXPECT_EQ(log.statistics.nan, 1U);
    EXPECT_EQ(log.frames.size(), 9U);
    EXPECT_EQ(log.frames[4].lost_before, 1U);
    ASSERT_EQ(log.problems.size(), 1U);
    EXPECT_THAT(log.problems[0], HasSubstr("nan.csv:7:"));
}

TEST_F(DotReader, refuses_repeated_and_irregular_times)
{
    const Log log = read_all(write("time.csv", header() + rows(0, 5) + row(4 * step_us) + row(6 * step_us) + rows(7 * step_us, 3) +
                                                   row(9 * step_us + 4000) + rows(9 * step_us + 4000 + step_us, 3)));
    expect_orderly(log);
    EXPECT_EQ(log.statistics.repeated, 1U);
    EXPECT_EQ(log.statistics.irregular, 2U);
    EXPECT_EQ(log.frames.size(), 4U + 3U + 3U);
    EXPECT_EQ(log.frames[4].lost_before, 2U);
    EXPECT_DOUBLE_EQ(log.frames[4].interval_s, 0.008333);
}

TEST_F(DotReader, goes_on_after_its_clock_jumped_back)
{
    const Log log = read_all(write("back.csv", header() + rows(10'000'000, 10) + rows(500'000, 10)));
    expect_orderly(log);
    EXPECT_EQ(log.statistics.irregular, 1U);
    EXPECT_EQ(log.frames.size(), 9U + 9U);
}

TEST_F(DotReader, counts_damaged_lines)
{
    const Log log = read_all(write("damaged.csv", header() + rows(0, 5) + row(5 * step_us, "1,2,x,4,5,6") + std::to_string(6 * step_us) +
                                                      ",0,0\n" + std::string(10000, '7') + "\n" + rows(7 * step_us, 3)));
    expect_orderly(log);
    EXPECT_EQ(log.statistics.malformed, 3U);
    EXPECT_EQ(log.problems.size(), 4U) << "after the line without a time, the clock has made a double step";
    EXPECT_THAT(log.problems[0], AllOf(HasSubstr("damaged.csv:7:"), HasSubstr("'x'")));
    EXPECT_THAT(log.problems[2], AllOf(HasSubstr("damaged.csv:9:"), HasSubstr("too long")));
    EXPECT_EQ(log.frames.size(), 4U + 2U);
}

TEST_F(DotReader, says_what_a_header_lacks)
{
    EXPECT_THAT(open_log(write("gyro.csv", "SampleTimeFine,Acc_X,Acc_Y,Acc_Z\n1,2,3,4\n")).error(),
                AllOf(HasSubstr("gyro.csv:1:"), HasSubstr("Gyr_X")));
    EXPECT_THAT(open_log(write("short.csv", header() + row(0))).error(), HasSubstr("short.csv:1:"));
    EXPECT_THAT(open_log(write("other.csv", "a,b,c\n1,2,3\n")).error(), HasSubstr("increment_0"));
}

TEST(DotRecording, refuses_the_corrupted_sample_of_the_flight)
{
    const auto folder = data_dir() / "ansfl_quadrotor_4xDOT";
    if (!std::filesystem::exists(folder)) GTEST_SKIP() << "no recordings under " << data_dir();
    int files = 0;
    for (const auto& entry : std::filesystem::directory_iterator(folder / "StraightLine" / "RAW")) {
        const std::string name = entry.path().filename().string();
        if (name.find("_1114") == std::string::npos) continue;
        ++files;
        const Log log = read_all(entry.path());
        expect_orderly(log);
        const bool damaged = name.find("DOT7") != std::string::npos;
        EXPECT_EQ(log.problems.size(), damaged ? 2U : 0U) << name;
        if (damaged) {
            EXPECT_THAT(log.problems, testing::ElementsAre(HasSubstr(":3908:"), HasSubstr(":3909:")));
            EXPECT_EQ(log.statistics.nan, 1U);
        }
        for (const RecordedFrame& frame : log.frames)
            for (std::size_t k = 0; k < 3; ++k) ASSERT_TRUE(std::isfinite(frame.increment[k]) && std::isfinite(frame.acceleration_m_s2[k]));
    }
    EXPECT_EQ(files, 4);
}

TEST(DotRecording, refuses_the_irregular_steps_of_the_path)
{
    const auto file = data_dir() / "ansfl_quadrotor_4xDOT" / "Horizontal" / "path_11" / "IMU_2.csv";
    if (!std::filesystem::exists(file)) GTEST_SKIP() << "no recordings under " << data_dir();
    const Log log = read_all(file);
    expect_orderly(log);
    EXPECT_EQ(log.statistics.irregular + log.statistics.repeated, 4U);
    EXPECT_EQ(log.problems.size(), 4U);
}

}  // namespace
}  // namespace quorient::recording
