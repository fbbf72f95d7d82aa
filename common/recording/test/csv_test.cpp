#include "log_files.hpp"
#include "quorient/recording/csv_writer.hpp"

#include <gmock/gmock.h>
#include <cmath>
#include <random>
#include <sstream>

namespace quorient::recording {
namespace {

using testing::HasSubstr;

class Csv : public LogFiles {};

SensorFrame frame_of(std::uint64_t sequence, std::mt19937_64& random)
{
    std::uniform_real_distribution<double> uniform(-0.01, 0.01);
    SensorFrame frame;
    frame.sequence = sequence;
    frame.sample_time_ns = static_cast<std::int64_t>(sequence + 1) * 5'000'000;
    frame.interval_s = 0.005;
    frame.axis_count = 4;
    frame.valid_mask = 0b1111;
    for (std::size_t axis = 0; axis < 4; ++axis) frame.increment[axis] = uniform(random);
    return frame;
}

TEST_F(Csv, gives_back_bit_for_bit_what_was_written)
{
    std::mt19937_64 random(7);
    std::ostringstream text;
    CsvWriter writer(text, 4, true);
    std::vector<SensorFrame> frames;
    std::vector<TruthState> truths;
    for (std::uint64_t sequence = 0; sequence < 200; ++sequence) {
        frames.push_back(frame_of(sequence, random));
        TruthState truth;
        truth.attitude = {std::cos(0.1 * static_cast<double>(sequence)), 0, std::sin(0.1 * static_cast<double>(sequence)), 0};
        truths.push_back(truth);
        writer.write(frames.back(), &truths.back());
    }
    const Log log = read_all(write("run.csv", text.str()));
    expect_orderly(log);
    ASSERT_EQ(log.frames.size(), 200U);
    for (std::size_t i = 0; i < 200; ++i) {
        EXPECT_EQ(log.frames[i].increment, frames[i].increment);
        EXPECT_EQ(log.frames[i].time_ns, frames[i].sample_time_ns);
        EXPECT_EQ(log.frames[i].interval_s, 0.005);
        EXPECT_EQ(log.frames[i].truth, truths[i].attitude);
    }
}

TEST_F(Csv, keeps_which_axis_had_no_sample)
{
    std::mt19937_64 random(7);
    std::ostringstream text;
    CsvWriter writer(text, 4, false);
    for (std::uint64_t sequence = 0; sequence < 10; ++sequence) {
        SensorFrame frame = frame_of(sequence, random);
        if (sequence == 3) frame.valid_mask = 0b1101;
        writer.write(frame, nullptr);
    }
    const Log log = read_all(write("run.csv", text.str()));
    expect_orderly(log);
    ASSERT_EQ(log.frames.size(), 10U);
    EXPECT_EQ(log.frames[3].valid_mask, 0b1101U);
    EXPECT_EQ(log.frames[4].valid_mask, 0b1111U);
    EXPECT_EQ(log.statistics.incomplete, 1U);
    EXPECT_FALSE(log.frames[3].truth);
}

TEST_F(Csv, says_where_a_gap_is)
{
    const Log log = read_all(
        write("gap.csv", "time,increment_0,increment_1,increment_2\n0.1,1,2,3\n0.2,1,2,3\n0.3,1,2,3\n# a comment\n0.6,1,2,3\n0.7,1,2,3\n"));
    expect_orderly(log);
    ASSERT_EQ(log.frames.size(), 5U);
    EXPECT_EQ(log.frames[3].lost_before, 2U);
    EXPECT_DOUBLE_EQ(log.frames[3].interval_s, 0.1);
    EXPECT_EQ(log.frames[3].position, 6U);
    EXPECT_EQ(log.statistics.lost, 2U);
}

TEST_F(Csv, refuses_repeated_backward_and_irregular_times)
{
    const Log log = read_all(write("time.csv", "time,increment_0\n0.1,1\n0.2,1\n0.2,1\n0.3,1\n0.1,1\n0.2,1\n0.35,1\n0.45,1\n"));
    expect_orderly(log);
    EXPECT_EQ(log.statistics.repeated, 1U);
    EXPECT_EQ(log.statistics.irregular, 2U);
    EXPECT_EQ(log.frames.size(), 5U);
}

TEST_F(Csv, names_the_line_of_a_bad_cell)
{
    const Log log =
        read_all(write("bad.csv", "time,increment_0,increment_1\n0.1,1,2\n0.2,1,2\n0.3,1,zwei\n0.4,1\n0.5,nan,nan\n0.6,1,2\nx,1,2\n"));
    expect_orderly(log);
    EXPECT_THAT(log.problems, testing::ElementsAre(AllOf(HasSubstr("bad.csv:4:"), HasSubstr("'zwei'")), HasSubstr("bad.csv:5:"),
                                                   HasSubstr("bad.csv:6:"), AllOf(HasSubstr("bad.csv:8:"), HasSubstr("'x'"))));
    EXPECT_EQ(log.statistics.malformed, 3U);
    EXPECT_EQ(log.statistics.nan, 1U);
}

TEST_F(Csv, refuses_headers_that_make_no_sense)
{
    EXPECT_THAT(open_log(write("a.csv", "increment_0\n1\n2\n")).error(), AllOf(HasSubstr("a.csv:1:"), HasSubstr("time")));
    EXPECT_THAT(open_log(write("b.csv", "time,increment_0,truth_w\n1,1,1\n2,1,1\n")).error(), HasSubstr("truth_z"));
    std::string header = "time";
    for (int axis = 0; axis < 25; ++axis) header += ",increment_" + std::to_string(axis);
    EXPECT_THAT(open_log(write("c.csv", header + "\n")).error(), HasSubstr("24"));
    EXPECT_THAT(open_log(write("d.csv", "time,increment_0\n0.5,1\n0.5,1\n")).error(), HasSubstr("d.csv:1:"));
}

TEST_F(Csv, survives_any_damage)
{
    std::mt19937_64 random(7);
    std::ostringstream text;
    CsvWriter writer(text, 4, false);
    for (std::uint64_t sequence = 0; sequence < 50; ++sequence) writer.write(frame_of(sequence, random), nullptr);
    for (int trial = 0; trial < 300; ++trial) {
        std::string damaged = text.str();
        for (auto hit = random() % 30; hit > 0; --hit) damaged[random() % damaged.size()] = static_cast<char>(random() % 128);
        damaged.resize(damaged.size() - random() % 100);
        const auto reader = open_log(write("damaged.csv", damaged));
        if (!reader) continue;
        SCOPED_TRACE(testing::Message() << "trial " << trial);
        expect_orderly(read_all(**reader));
    }
}

}  // namespace
}  // namespace quorient::recording
