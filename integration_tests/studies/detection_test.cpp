#include "data_folder.hpp"
#include "detection_cells.hpp"
#include "quorient/diagnosis/px4_rule.hpp"
#include "quorient/messages/units.hpp"
#include "study.hpp"
#include "quorient/geometry/layouts.hpp"

#include <gtest/gtest.h>
#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <random>

namespace quorient::studies {

using diagnosis::Px4Rule;
namespace {

constexpr double interval_s = 0.016;

std::filesystem::path data_dir()
{
    return recording::data_folder(QUORIENT_SOURCE_DIR);
}

/// Three instruments at rest for 60 s, with white noise of 0.2 deg/s.
RecordedArray resting_array(std::uint64_t seed)
{
    RecordedArray array;
    array.name = "simulated";
    array.cluster = geometry::layout("triads-3").value();
    array.cluster.sigma.setConstant(0.2 * degree * interval_s);
    array.cluster.quantum.setZero();
    array.cluster.range.setConstant(2000 * degree);
    array.cluster.interval_s = interval_s;
    std::mt19937_64 random(seed);
    std::normal_distribution<double> noise(0, 0.2 * degree * interval_s);
    for (std::uint64_t sequence = 0; sequence < 3750; ++sequence) {
        SensorFrame frame;
        frame.epoch = 1;
        frame.sequence = sequence;
        frame.sample_time_ns = static_cast<std::int64_t>(sequence + 1) * 16'000'000;
        frame.interval_s = interval_s;
        frame.axis_count = 9;
        frame.valid_mask = 0b111111111;
        for (std::size_t axis = 0; axis < 9; ++axis) frame.increment[axis] = noise(random);
        array.frames.push_back(frame);
    }
    array.rest = {{0, array.frames.size()}};
    return array;
}

TrialResult played(double bias_deg_s, bool instruments)
{
    const RecordedArray array = resting_array(3);
    Trial trial;
    trial.fault.kind = FaultKind::bias;
    trial.fault.value = bias_deg_s * degree;
    trial.onset = 1000;
    trial.axis = 4;
    trial.allowed = instruments ? 0b111000 : 0b10000;
    return play(array, trial, accumulating(array, instruments));
}

TEST(DetectionTrial, judges_the_isolation_of_the_axis_or_of_its_instrument_right)
{
    for (const bool instruments : {false, true}) {
        const TrialResult result = played(5, instruments);
        EXPECT_EQ(result.ours.judgement, Judgement::right);
        EXPECT_GE(result.ours.isolated_s(), interval_s);
        EXPECT_LE(result.ours.isolated_s(), 0.1);
        EXPECT_LE(std::abs(result.onset_error_s), 3 * interval_s);
        EXPECT_GT(result.attitude_bound_rad, 0.1 * degree * 0.999);
        EXPECT_LE(result.attitude_error_rad, result.attitude_bound_rad);
    }
}

TEST(DetectionTrial, judges_a_named_instrument_wrong_where_an_axis_was_asked_for)
{
    const RecordedArray array = resting_array(3);
    Trial trial;
    trial.fault.kind = FaultKind::bias;
    trial.fault.value = 5 * degree;
    trial.onset = 1000;
    trial.axis = 4;
    trial.allowed = 0b10000;
    EXPECT_EQ(play(array, trial, accumulating(array, true)).ours.judgement, Judgement::wrong);
}

TEST(DetectionTrial, calls_a_fault_missed_that_nobody_sees)
{
    const TrialResult result = played(1e-4, true);
    EXPECT_EQ(result.ours.judgement, Judgement::missed);
    EXPECT_EQ(result.px4.judgement, Judgement::missed);
    EXPECT_TRUE(std::isinf(result.ours.isolated_s()));
}

// Two thirds of a fault differ from the mean of three; d is that, smoothed with time constant tau = 20 samples:
// integral of d (1 - exp(-t / tau)) - 7 deg/s, never below 0, reaches 15 deg.
double px4_delay_s(double fault_deg_s)
{
    double smoothed = 0, integral = 0, time = 0;
    while (integral <= 15) {
        smoothed += 0.05 * (2.0 / 3 * fault_deg_s - smoothed);
        integral = std::max(0.0, integral + (smoothed - 7) * interval_s);
        time += interval_s;
    }
    return time;
}

TEST(Px4Rule, finds_what_its_description_says_it_finds_and_when)
{
    EXPECT_NEAR(px4_delay_s(22.9), 2.30, 0.05) << "the published emulation";
    EXPECT_NEAR(px4_delay_s(60), 0.78, 0.03);
    for (const double fault : {22.9, 60.0}) {
        const TrialResult result = played(fault, true);
        EXPECT_EQ(result.px4.judgement, Judgement::right) << fault;
        EXPECT_NEAR(result.px4.isolated_s(), px4_delay_s(fault), 0.02 * px4_delay_s(fault)) << fault;
    }
    EXPECT_EQ(played(10, true).px4.judgement, Judgement::missed) << "two thirds of 10 deg/s are below 7";
}

class RealRecordings : public testing::Test {
protected:
    /// exp_1 and exp_2, IMUs 1, 3, 5 and all, each corrected by the other one's calibration.
    static void SetUpTestSuite()
    {
        const auto folder = data_dir() / "mimu4444_carlsson";
        if (!std::filesystem::exists(folder)) return;
        logs = {folder / "exp_1" / "data.bin", folder / "exp_2" / "data.bin"};
        arrays = load_arrays(logs).value();
    }

    void SetUp() override
    {
        if (arrays.empty()) GTEST_SKIP() << "no recordings under " << data_dir();
    }

    static fdi::FaultMonitor watched(const RecordedArray& array, bool instruments) { return accumulating(array, instruments); }

    CellResult cell(std::size_t array, bool moving, double bias_deg_s, std::size_t trials, std::uint64_t seed = 1) const
    {
        Cell cell;
        cell.array = array;
        cell.moving = moving;
        cell.fault.kind = FaultKind::bias;
        cell.fault.value = bias_deg_s * degree;
        RunSettings settings;
        settings.trials = trials;
        settings.seed = seed;
        return play_cells(arrays, {cell}, watched, settings, {}).front();
    }

    static inline std::vector<std::filesystem::path> logs;
    static inline std::vector<RecordedArray> arrays;
};

TEST_F(RealRecordings, blame_nobody_without_a_fault)
{
    for (std::size_t array = 0; array < arrays.size(); ++array) {
        const HealthyRun run = play_healthy(arrays, array, true, watched);
        EXPECT_EQ(run.false_isolations, 0U) << arrays[array].name;
        EXPECT_GT(run.duration_s, 598);
    }
}

TEST_F(RealRecordings, show_small_faults_at_rest_soon)
{
    for (std::size_t array = 0; array < arrays.size(); ++array) {
        const CellResult result = cell(array, false, 1, 15);
        EXPECT_EQ(result.ours.right, 15U) << arrays[array].name;
        EXPECT_LE(result.ours.median_isolated_s, 0.15) << arrays[array].name;
    }
}

TEST_F(RealRecordings, show_a_field_fault_in_violent_motion_within_half_a_second_and_name_the_instrument)
{
    for (std::size_t array = 0; array < arrays.size(); ++array) {
        const CellResult result = cell(array, true, 22.9, 60);
        EXPECT_EQ(result.ours.right, 60U) << arrays[array].name;
        EXPECT_LE(result.ours.median_isolated_s, 0.5) << arrays[array].name;
        EXPECT_LT(result.ours.median_isolated_s, result.px4.median_isolated_s) << arrays[array].name;
    }
}

TEST_F(RealRecordings, played_with_several_seeds_have_the_median_of_all_trials_together)
{
    RunSettings settings;
    settings.trials = 1;
    settings.seed = 11;
    settings.logs = logs;
    const Report report = detection_seeds(settings, {});
    ASSERT_EQ(report.json["rows"].size(), 3 * arrays.size());
    for (const auto& row : report.json["rows"]) {
        auto medians = row["medians_s"].get<std::vector<double>>();
        ASSERT_EQ(medians.size(), 5U);
        std::sort(medians.begin(), medians.end());
        EXPECT_EQ(row["pooled_median_s"], medians[2]) << row;
        EXPECT_EQ(row["right"], 5) << row;
        EXPECT_GE(row["interval_s"][0], medians.front());
        EXPECT_LE(row["interval_s"][0], medians[2]);
        EXPECT_LE(row["interval_s"][1], medians.back());
        EXPECT_GE(row["interval_s"][1], medians[2]);
    }
    EXPECT_EQ(report.json["rows"][2]["medians_s"][3], cell(0, true, 22.9, 1, 14).ours.median_isolated_s) << "seed 14 alone";
}

}  // namespace
}  // namespace quorient::studies
