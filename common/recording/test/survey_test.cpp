#include "quorient/recording/aligned_logs.hpp"

#include "instrument_log_test.hpp"
#include "writers/dataflash_writer.hpp"

#include <gmock/gmock.h>
#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <random>
#include <sstream>

namespace quorient::recording {
namespace {

using testing::Contains;
using testing::ElementsAre;
using testing::HasSubstr;

class Surveyed : public LogFiles {};

std::vector<std::string> compared_names(const Survey& survey)
{
    std::vector<std::string> names;
    for (const std::size_t i : survey.compared) names.push_back(survey.instruments[i].instrument.name);
    return names;
}

Survey survey_of(const std::vector<std::filesystem::path>& files, const LogOptions& options = {})
{
    auto found = survey(files, options);
    if (!found) {
        ADD_FAILURE() << found.error();
        return {};
    }
    const auto tied = tie_clocks(*found);
    EXPECT_TRUE(tied) << tied.error();
    return std::move(*found);
}

std::vector<AlignedFrame> frames_of(const Survey& survey)
{
    auto logs = AlignedLogs::open(survey);
    std::vector<AlignedFrame> frames;
    if (!logs) {
        ADD_FAILURE() << logs.error();
        return frames;
    }
    AlignedFrame frame;
    for (auto outcome = logs->next(frame); outcome != ReadOutcome::end; outcome = logs->next(frame))
        if (outcome == ReadOutcome::frame) frames.push_back(frame);
    return frames;
}

/// A log whose clock shows offset + t (1 + slope) at time t.
std::string log_of(double period_s, double duration_s, double offset_s, double slope, unsigned seed)
{
    std::mt19937 random(seed);
    std::normal_distribution<double> noise(0.0, 0.002);
    std::ostringstream text;
    text.precision(12);
    text << "t [s],gx [rad/s],gy [rad/s],gz [rad/s]\n";
    for (double t = 3 * period_s * (seed % 3); t < duration_s; t += period_s) {
        const double turn = std::sin(0.9 * t) + 0.5 * std::sin(2.3 * t + 1) * std::sin(0.05 * t);
        text << offset_s + t * (1 + slope) << ',' << turn + noise(random) << ',' << noise(random) << ',' << noise(random) << '\n';
    }
    return text.str();
}

TEST_F(Surveyed, puts_the_instruments_of_a_table_in_the_order_of_their_numbers)
{
    std::string text = "time_ms,id,gx_dps,gy_dps,gz_dps\n";
    for (int i = 0; i < 200; ++i)
        for (const int id : {10, 2, 1}) text += std::to_string(10 * i) + "," + std::to_string(id) + ",1," + std::to_string(i % 7) + ",3\n";
    const Survey found = survey_of({write("long.csv", text)});
    EXPECT_THAT(compared_names(found), ElementsAre("id1", "id2", "id10"));
    for (const AlignedFrame& frame : frames_of(found)) EXPECT_EQ(frame.valid_mask, 0b111'111'111U);
}

TEST_F(Surveyed, says_that_the_unit_is_wrong_where_rates_are_beyond_any_gyro)
{
    const auto turning = [](const std::string& unit, int every) {
        std::string text = "time_s,g0x [" + unit + "],g0y [" + unit + "],g0z [" + unit + "]\n";
        for (int i = 0; i < 1000; ++i) text += std::to_string(0.01 * i) + "," + (i % every == 0 ? "180" : "0.5") + ",0.1,0.2\n";
        return text;
    };
    EXPECT_THAT(survey_of({write("wrong.csv", turning("rad/s", 3))}).remarks, Contains(HasSubstr("unit is probably wrong")));
    EXPECT_TRUE(survey_of({write("right.csv", turning("deg/s", 3))}).remarks.empty());
    EXPECT_TRUE(survey_of({write("spikes.csv", turning("rad/s", 250))}).remarks.empty()) << "a few shocks are no wrong unit";
}

TEST_F(Surveyed, ties_clocks_that_differ_in_offset_and_pace)
{
    const auto first = write("a.csv", log_of(0.01, 400, 0, 0, 3));
    for (const auto& [offset_s, slope] : std::vector<std::pair<double, double>>{{0.731, 0}, {-1.2, 80e-6}, {0.05, -40e-6}}) {
        SCOPED_TRACE(offset_s);
        // Clocks of their own: the second log's time begins at another date.
        const Survey found = survey_of({first, write("b.csv", log_of(0.0101, 400, 5e6, slope, 3))});
        EXPECT_FALSE(found.one_epoch);
        const ClockFigures& clock = found.instruments[found.compared[1]].clock;
        EXPECT_TRUE(clock.tied);
        EXPECT_NEAR(clock.offset_s, 0, 0.002);
        EXPECT_NEAR(clock.slope, slope, 4e-6);
        const Survey same = survey_of({first, write("c.csv", log_of(0.0101, 400, offset_s < 0 ? -0.6 : offset_s, slope, 4))});
        EXPECT_TRUE(same.one_epoch);
        EXPECT_NEAR(same.instruments[same.compared[1]].clock.offset_s, offset_s < 0 ? -0.6 : offset_s, 0.002);
        double sum = 0;
        std::size_t count = 0;
        for (const AlignedFrame& frame : frames_of(same)) {
            if (frame.valid_mask != 0b111'111U) continue;
            sum += std::pow(frame.rate_rad_s[0][0] - frame.rate_rad_s[1][0], 2);
            ++count;
        }
        EXPECT_GT(count, 39'000U);
        EXPECT_LT(std::sqrt(sum / static_cast<double>(count)), 0.005) << "noise of 0.003, and no more";
    }
}

TEST_F(Surveyed, refuses_logs_of_different_motions_that_share_no_clock)
{
    auto found = survey(std::vector<std::filesystem::path>{write("a.csv", log_of(0.01, 100, 0, 0, 3)),
                                                           write("b.csv", log_of(0.01, 100, 5e6, 3.0, 3))}, {});
    ASSERT_TRUE(found);
    EXPECT_THAT(tie_clocks(*found).error(), AllOf(HasSubstr("a.csv"), HasSubstr("b.csv"), HasSubstr("same motion")));
}

/// Three instruments in the same rows, each with its own bias [deg/s], in a slow motion about all axes after a rest.
std::string table_of_biased_instruments(unsigned seed, double pace, double late_s)
{
    std::mt19937 random(seed);
    std::normal_distribution<double> bias(0.0, 1.0), noise(0.0, 0.1);
    std::array<double, 9> biases;
    for (double& one : biases) one = bias(random);
    std::ostringstream text;
    text << "time_s";
    for (const char* name : {"a", "b", "c"})
        for (const char* axis : {"x", "y", "z"}) text << ",imu_" << name << "_g" << axis << " [deg/s]";
    text << '\n';
    const auto moved = [&](double t, std::size_t axis) {
        const double swing = std::clamp(t - 6, 0.0, 1.0);
        return swing * (axis == 0 ? 30 * std::sin(0.7 * pace * t) : axis == 1 ? 20 * std::sin(1.1 * pace * t + 0.3) : 25 * std::sin(0.5 * pace * t));
    };
    for (int row = 0; row < 9000; ++row) {
        const double t = 0.005 * row;
        text << t;
        for (std::size_t i = 0; i < 9; ++i) text << ',' << moved(i < 6 ? t : t - late_s, i % 3) + biases[i] + noise(random);
        text << '\n';
    }
    return text.str();
}

TEST_F(Surveyed, takes_no_bias_for_an_offset_of_the_clock)
{
    for (const double pace : {1.0, 2.0, 3.0})
        for (const unsigned seed : {1U, 2U, 3U, 4U}) {
            SCOPED_TRACE(testing::Message() << "pace " << pace << ", seed " << seed);
            const Survey found = survey_of({write("table.csv", table_of_biased_instruments(seed, pace, 0.02))});
            ASSERT_EQ(found.compared.size(), 3U);
            EXPECT_NEAR(found.instruments[found.compared[1]].clock.offset_s, 0, 0.001);
            const ClockFigures& late = found.instruments[found.compared[2]].clock;
            EXPECT_TRUE(late.tied);
            EXPECT_NEAR(late.offset_s, 0.02, 0.001);
        }
}

TEST_F(Surveyed, ties_no_clocks_by_a_steady_turn)
{
    const auto steady = [](unsigned seed) {
        std::mt19937 random(seed);
        std::normal_distribution<double> noise(0.0, 1e-4);
        std::ostringstream text;
        text << "t [s],gx [rad/s],gy [rad/s],gz [rad/s]\n";
        for (int i = 0; i < 6000; ++i) text << 0.01 * i << ',' << 1e-4 * i + noise(random) << ",0,0\n";
        return text.str();
    };
    const Survey found = survey_of({write("a.csv", steady(1)), write("b.csv", steady(2))});
    const ClockFigures& clock = found.instruments[found.compared[1]].clock;
    EXPECT_GT(clock.correlation, 0.99) << "alike, at any offset";
    EXPECT_FALSE(clock.tied);
    EXPECT_EQ(clock.offset_s, 0);
}

TEST_F(Surveyed, gives_frames_of_any_log_where_a_reader_of_frames_is_asked_for)
{
    const auto reader = open_log(write("log.bin", test::dataflash_of_three_imus(500)));
    ASSERT_TRUE(reader) << reader.error();
    const ClusterDescription& description = (*reader)->description();
    EXPECT_EQ(description.axis_count, 9);
    EXPECT_EQ(std::string(description.instrument_name[1].data()), "IMU2");
    EXPECT_EQ(description.instrument[8], 2);
    EXPECT_EQ(description.axis[4], (std::array<double, 3>{0, 1, 0}));
    EXPECT_NEAR(description.interval_s, 0.04, 1e-9);
    const Log log = read_all(**reader);
    expect_orderly(log);
    ASSERT_EQ(log.frames.size(), 500U);
    EXPECT_EQ(log.frames[20].valid_mask, all_axes(9));
    EXPECT_NEAR(log.frames[20].increment[5], 2 * 1.020 * 0.04, 1e-6) << "z of IMU2 in row 20";
    EXPECT_NEAR(log.frames[20].acceleration_m_s2[5], -9.8, 1e-5);
}

TEST_F(Surveyed, describes_the_range_that_an_axis_stayed_at)
{
    std::ostringstream table;
    table << "time_s,g0x [rad/s],g0y [rad/s],g0z [rad/s],g1x [rad/s],g1y [rad/s],g1z [rad/s]\n";
    for (int i = 0; i < 4000; ++i) {
        const double rate = 5.2 * std::sin(0.01 * i);
        table << 0.005 * i << ',' << rate << ",0.1," << 0.1 * rate << ',' << std::clamp(rate, -4.36, 4.36) << ",0.1," << 0.1 * rate << '\n';
    }
    const auto reader = open_log(write("clipped.csv", table.str()));
    ASSERT_TRUE(reader) << reader.error();

    const auto& range = (*reader)->description().range;
    EXPECT_EQ((*reader)->description().axis_count, 6);
    EXPECT_EQ(range[0], 0) << "the top of the motion is no range";
    EXPECT_EQ(range[3], 4.36);
    EXPECT_EQ(range[5], 0);
}

TEST(SurveyedRange, is_the_stated_one_even_where_an_axis_ends_below_it)
{
    SurveyedInstrument surveyed;
    EXPECT_EQ(surveyed.range_rad_s(0), 0);
    surveyed.figures.range_reached[0] = Clipping{4.36, 100, 0, 0};
    EXPECT_EQ(surveyed.range_rad_s(0), 4.36);
    surveyed.instrument.range_rad_s = 34.9;
    EXPECT_EQ(surveyed.range_rad_s(0), 34.9) << "a live system knows no other, and its replay must judge alike";
}

TEST_F(Surveyed, keeps_a_bounded_part_of_a_long_log)
{
    auto found = survey(std::vector<std::filesystem::path>{write("a.csv", log_of(0.01, 599, 0, 0, 3))}, {});
    ASSERT_TRUE(found);
    ASSERT_EQ(found->instruments[0].windows.size(), 30U);
    std::size_t kept = 0;
    for (const KeptWindow& window : found->instruments[0].windows) kept += window.size();
    EXPECT_EQ(kept, found->instruments[0].figures.samples) << "a short one whole";
}

/// Three instruments at 100 Hz in one long table; the stamps of IMU1 are elsewhere for two seconds.
std::string log_with_an_epoch_of_another(double away_s)
{
    std::ostringstream text;
    text.precision(15);
    text << "t [s],id,gx [rad/s],gy [rad/s],gz [rad/s]\n";
    for (int i = 0; i < 3000; ++i)
        for (int imu = 0; imu < 3; ++imu) {
            const bool away = imu == 1 && i >= 1000 && i < 1200;
            text << 1e6 + 0.01 * i + (away ? away_s : 0) << ",IMU" << imu << ',' << std::sin(0.02 * i) << ",0.1," << 0.2 * imu << '\n';
        }
    return text.str();
}

TEST_F(Surveyed, loses_one_instrument_while_its_stamps_are_of_another_epoch_and_nothing_else)
{
    for (const double away_s : {-9e5, 5e8, -1.0}) {
        SCOPED_TRACE(away_s);
        const Survey found = survey_of({write("log.csv", log_with_an_epoch_of_another(away_s))});
        ASSERT_THAT(compared_names(found), ElementsAre("IMU0", "IMU1", "IMU2"));
        EXPECT_EQ(found.instruments[1].figures.steps_back, 1U);
        EXPECT_EQ(found.instruments[0].figures.steps_back, 0U);
        const auto frames = frames_of(found);
        ASSERT_NEAR(static_cast<double>(frames.size()), 3000, 1);
        std::size_t missing = 0;
        for (const AlignedFrame& frame : frames) {
            EXPECT_NEAR(frame.interval_s, 0.01, 1e-4);
            EXPECT_EQ(frame.valid_mask & 0b111'000'111U, 0b111'000'111U);
            missing += has_axis(frame.valid_mask, 3) ? 0 : 1;
            if (has_axis(frame.valid_mask, 3)) {
                EXPECT_NEAR(frame.rate_rad_s[1][0], frame.rate_rad_s[0][0], 0.004) << "the row before or after is off by up to 0.02";
            }
        }
        EXPECT_NEAR(static_cast<double>(missing), 200, 2);
    }
}

TEST(SurveyedField, compares_what_holds_the_motion_whole)
{
    if (!std::filesystem::exists(field_dir())) GTEST_SKIP() << "no logs under " << field_dir();
    const Survey px4 = survey_of({field_dir() / "px4_3_imus.ulg"});
    EXPECT_THAT(compared_names(px4), ElementsAre("sensor_combined"));
    for (const SurveyedInstrument& instrument : px4.instruments) {
        if (instrument.instrument.source == "vehicle_imu") {
            EXPECT_NEAR(instrument.figures.coverage, 0.01, 0.003);
        }
        if (instrument.instrument.source == "sensor_combined") {
            const double samples = static_cast<double>(instrument.figures.samples);
            EXPECT_NEAR(samples / instrument.figures.duration_s(), 199.7, 0.5) << "with its gaps";
            EXPECT_NEAR(samples + static_cast<double>(instrument.figures.lost), instrument.figures.duration_s() * instrument.figures.rate_hz(), 3);
            EXPECT_GE(instrument.figures.longest_gap_s, 0.16);
        }
    }
    EXPECT_THAT(compared_names(survey_of({field_dir() / "ardupilot_3_imus_crash.bin"})), ElementsAre("IMU", "IMU2", "IMU3"));
    EXPECT_THAT(compared_names(survey_of({field_dir() / "ardupilot_2_imus_hole.bin"})), ElementsAre("IMU", "IMU2")) << "a hole of 628 s";
    EXPECT_THAT(compared_names(survey_of({field_dir() / "cats_drone_healthy.csv"})), ElementsAre("g0", "g1", "g2"));
}

TEST(SurveyedField, pairs_rows_by_time_where_one_is_missing)
{
    const auto file = field_dir() / "cats_rocket_healthy_long.csv";
    if (!std::filesystem::exists(file)) GTEST_SKIP() << "no log " << file;
    const Survey found = survey_of({file});
    std::size_t complete = 0, frames = 0;
    for (const AlignedFrame& frame : frames_of(found)) {
        ++frames;
        complete += frame.valid_mask == 0b111'111'111U ? 1 : 0;
    }
    EXPECT_NEAR(static_cast<double>(frames), 9365, 2);
    EXPECT_GE(complete + 3, frames);
}

/// Root mean square of how much the rates of turn of two instruments differ [deg/s], slow differences left out.
double disagreement_deg_s(const std::vector<AlignedFrame>& frames, std::size_t a, std::size_t b)
{
    constexpr double degree = std::numbers::pi / 180;
    double slow = 0, sum = 0;
    std::size_t count = 0;
    for (const AlignedFrame& frame : frames) {
        if (!has_axis(frame.valid_mask, 3 * a) || !has_axis(frame.valid_mask, 3 * b)) continue;
        if (static_cast<double>(frame.time_ns) * 1e-9 > 58) break;
        const auto norm = [&](std::size_t i) { return std::hypot(frame.rate_rad_s[i][0], frame.rate_rad_s[i][1], frame.rate_rad_s[i][2]); };
        const double difference = (norm(a) - norm(b)) / degree;
        slow += 0.01 * (difference - slow);
        sum += (difference - slow) * (difference - slow);
        ++count;
    }
    return std::sqrt(sum / static_cast<double>(count));
}

TEST(SurveyedField, places_late_stamps_on_the_instruments_own_clocks)
{
    if (!std::filesystem::exists(field_dir() / "rover_5_imus")) GTEST_SKIP() << "no logs under " << field_dir();
    std::vector<std::filesystem::path> files;
    for (int imu = 1; imu <= 5; ++imu) files.push_back(field_dir() / "rover_5_imus" / ("imu" + std::to_string(imu) + ".csv"));
    Survey found = survey_of(files);
    EXPECT_TRUE(found.one_epoch);
    ASSERT_EQ(found.compared.size(), 5U);
    const std::array rates_hz{105.56, 104.20, 104.37, 104.33, 102.99};  // README of the data
    for (std::size_t i = 0; i < 5; ++i) {
        const SurveyedInstrument& instrument = found.instruments[found.compared[i]];
        ASSERT_TRUE(instrument.arrival_period_s);
        EXPECT_NEAR(1 / *instrument.arrival_period_s, rates_hz[i], 0.02) << instrument.instrument.name;
        EXPECT_TRUE(instrument.clock.own_clock) << instrument.instrument.name;
        EXPECT_LE(instrument.clock.lost, 25U) << instrument.instrument.name;
    }
    const auto placed = frames_of(found);
    Survey stamped = found;
    for (const std::size_t i : stamped.compared) stamped.instruments[i].clock.own_clock = false;
    const auto as_stamped = frames_of(stamped);
    for (std::size_t i = 1; i < 5; ++i)
        EXPECT_LT(disagreement_deg_s(placed, 0, i), disagreement_deg_s(as_stamped, 0, i)) << "imu" << i + 1;
}

}  // namespace
}  // namespace quorient::recording
