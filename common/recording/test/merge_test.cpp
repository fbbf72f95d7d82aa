#include "quorient/recording/merge.hpp"

#include "log_files.hpp"

#include <gmock/gmock.h>
#include <cmath>
#include <random>
#include <sstream>

namespace quorient::recording {
namespace {

using testing::HasSubstr;

class Merge : public LogFiles {};

double turned(double t, double phase)
{
    return std::sin(0.9 * t + phase) + 0.5 * std::sin(2.3 * t) + 0.2 * std::sin(5.1 * t + 2 * phase);
}

/// A triad at 100 Hz that turns about its axis k by turned(t); its clock shows t - start at time t, and it has noise.
std::string triad_log(double start_s, double duration_s, int k, double phase, unsigned seed)
{
    std::mt19937 random(seed);
    std::normal_distribution<double> noise(0.0, 2e-5);
    std::ostringstream text;
    text.precision(17);
    text << "time,increment_0,increment_1,increment_2\n";
    for (int i = 1; i * 0.01 <= duration_s; ++i) {
        const double swept = turned(start_s + i * 0.01, phase) - turned(start_s + (i - 1) * 0.01, phase);
        text << i * 0.01;
        for (int axis = 0; axis < 3; ++axis) text << ',' << (axis == k ? swept : 0.0) + noise(random);
        text << '\n';
    }
    return text.str();
}

TEST_F(Merge, finds_how_far_two_clocks_are_apart)
{
    const auto a = write("a.csv", triad_log(0.0, 60, 0, 0.3, 1));
    for (const double start_s : {-0.7312, 0.0, 0.0437, 2.2051}) {
        const auto offset = estimate_offset(a, write("b.csv", triad_log(start_s, 60, 2, 0.3, 2)));
        ASSERT_TRUE(offset) << offset.error();
        EXPECT_NEAR(offset->offset_s, -start_s, 1e-3);
        EXPECT_GT(offset->correlation, 0.95);
    }
}

TEST_F(Merge, gives_every_instrument_the_same_rotation_at_the_same_time)
{
    const std::vector<std::filesystem::path> files{write("a.csv", triad_log(0.0, 60, 0, 0.3, 1)),
                                                   write("b.csv", triad_log(0.0437, 60, 2, 0.3, 2))};
    const auto merged = open_logs(files);
    ASSERT_TRUE(merged) << merged.error();
    EXPECT_EQ(merged->reader->description().axis_count, 6);
    EXPECT_EQ(merged->reader->description().instrument[4], 4);
    const Log log = read_all(*merged->reader);
    expect_orderly(log);
    ASSERT_GE(log.frames.size(), 5993U);
    ASSERT_LE(log.frames.size(), 5996U) << "the second log begins 44 ms later: so does the common one";
    double angle_a = 0;
    double angle_b = 0;
    for (std::size_t i = 0; i < log.frames.size(); ++i) {
        ASSERT_EQ(log.frames[i].valid_mask, 0b111111U) << "frame " << i;
        angle_a += log.frames[i].increment[0];
        angle_b += log.frames[i].increment[5];
        // The splitting at constant rate and an offset off by 1 ms are worth 2 mrad, the noise a random walk below 10 mrad.
        ASSERT_NEAR(angle_a, angle_b, 0.012) << "frame " << i;
    }
}

TEST_F(Merge, says_when_one_log_has_nothing_to_say)
{
    std::string second = triad_log(0.0, 60, 2, 0.3, 2);
    std::string holed;
    std::istringstream lines(second);
    int number = 0;
    for (std::string line; std::getline(lines, line); ++number)
        if (number < 3000 || number >= 3005) holed += line + "\n";
    const std::vector<std::filesystem::path> files{write("a.csv", triad_log(0.0, 60, 0, 0.3, 1)), write("b.csv", holed)};
    const auto merged = open_logs(files);
    ASSERT_TRUE(merged) << merged.error();
    const Log log = read_all(*merged->reader);
    std::size_t missing = 0;
    for (std::size_t i = 100; i < 5900; ++i) missing += log.frames[i].valid_mask == 0b111111U ? 0 : 1;
    EXPECT_GE(missing, 5U);
    EXPECT_LE(missing, 6U);
    EXPECT_EQ(log.statistics.lost, 5U);
}

/// Frames of a log of 60 s merged with one that ends after this time; how many of them have no second instrument.
struct Lengths {
    std::size_t frames = 0;
    std::size_t without_second = 0;
};

TEST_F(Merge, ends_with_the_log_that_is_switched_off_first_and_goes_on_where_one_fails)
{
    const auto lengths = [this](double second_s) {
        const std::vector<std::filesystem::path> files{write("a.csv", triad_log(0.0, 60, 0, 0.3, 1)),
                                                       write("b.csv", triad_log(0.0, second_s, 2, 0.3, 2))};
        const auto merged = open_logs(files).value();
        Lengths counted;
        for (const RecordedFrame& frame : read_all(*merged.reader).frames) {
            ++counted.frames;
            counted.without_second += frame.valid_mask == 0b000111U ? 1 : 0;
        }
        return counted;
    };
    const Lengths switched_off = lengths(59.5);
    EXPECT_NEAR(static_cast<double>(switched_off.frames), 5950, 2);
    EXPECT_EQ(switched_off.without_second, 0U);
    const Lengths failed = lengths(40);
    EXPECT_NEAR(static_cast<double>(failed.frames), 6000, 1);
    EXPECT_NEAR(static_cast<double>(failed.without_second), 2000, 2);
}

TEST_F(Merge, refuses_logs_of_different_motions)
{
    const auto a = write("a.csv", triad_log(0.0, 60, 0, 0.3, 1));
    const auto b = write("b.csv", triad_log(500.0, 60, 0, 1.9, 2));
    EXPECT_THAT(estimate_offset(a, b).error(), AllOf(HasSubstr("a.csv"), HasSubstr("b.csv"), HasSubstr("same motion")));
    const std::vector<std::filesystem::path> nine(9, a);
    EXPECT_THAT(open_logs(nine).error(), HasSubstr("24 axes"));
    EXPECT_FALSE(open_logs({}));
}

std::vector<std::filesystem::path> flight()
{
    std::vector<std::filesystem::path> files;
    const auto folder = data_dir() / "ansfl_quadrotor_4xDOT" / "StraightLine" / "RAW";
    if (!std::filesystem::exists(folder)) return files;
    for (const auto& entry : std::filesystem::directory_iterator(folder))
        if (entry.path().filename().string().find("_1114") != std::string::npos) files.push_back(entry.path());
    std::sort(files.begin(), files.end());
    return files;
}

TEST(MergedFlight, has_all_four_instruments_at_once)
{
    const auto files = flight();
    if (files.empty()) GTEST_SKIP() << "no recordings under " << data_dir();
    const auto merged = open_logs(files);
    ASSERT_TRUE(merged) << merged.error();
    for (const ClockOffset& offset : merged->offsets) {
        EXPECT_GT(offset.correlation, 0.99);
        EXPECT_LT(std::abs(offset.offset_s), 0.1);
    }
    EXPECT_STREQ(merged->reader->description().instrument_name[3].data(), "DOT7");
    const Log log = read_all(*merged->reader);
    expect_orderly(log);
    EXPECT_EQ(log.problems.size(), 2U) << "the corrupted sample and its neighbour";
    std::size_t complete = 0;
    for (const RecordedFrame& frame : log.frames) complete += frame.valid_mask == all_axes(12) ? 1 : 0;
    EXPECT_GT(log.frames.size(), 22'000U);
    EXPECT_GE(complete + 4, log.frames.size()) << "the refused samples";
}

TEST(MergedFlight, is_not_made_of_different_flights)
{
    const auto files = flight();
    if (files.empty()) GTEST_SKIP() << "no recordings under " << data_dir();
    EXPECT_THAT(estimate_offset(files[0], data_dir() / "ansfl_quadrotor_4xDOT" / "Horizontal" / "path_11" / "IMU_1.csv").error(),
                HasSubstr("same motion"));
}

}  // namespace
}  // namespace quorient::recording
