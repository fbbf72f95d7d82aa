#include "motion_terms_fit.hpp"
#include "quorient/geometry/layouts.hpp"
#include "quorient/calibration/gated_terms.hpp"
#include "quorient/messages/units.hpp"

#include <gtest/gtest.h>
#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>
#include <set>

namespace quorient::studies {
namespace {

constexpr double interval_s = 0.016;
constexpr double jitter_s = 0.3e-3;

/// Three instruments that rest twice for 10 s and then turn about all axes for `moving_s`, each sampling at its own, jittering time.
struct Recorded {
    ClusterDescription nominal;
    std::vector<calibration::Sample> samples;
    std::vector<calibration::Segment> rest{{0, 625}, {688, 1313}};
};

Eigen::Vector3d rate_at(double time_s)
{
    const auto turn = [time_s](double size, double hertz, double phase) {
        return size * std::sin(2 * std::numbers::pi * hertz * time_s + phase);
    };
    return {turn(8, 1.1, 0) + turn(2, 3.1, 1), turn(7, 0.9, 2), turn(6, 1.3, 4) + turn(3, 2.3, 5)};
}

ClusterDescription nominal_of(const geometry::SensorCluster& cluster)
{
    ClusterDescription nominal;
    nominal.interval_s = interval_s;
    nominal.axis_count = static_cast<std::uint8_t>(cluster.size());
    nominal.instrument_count = 3;
    for (std::size_t axis = 0; axis < cluster.size(); ++axis) {
        Eigen::Vector3d::Map(nominal.axis[axis].data()) = cluster.axes.row(static_cast<Eigen::Index>(axis));
        nominal.instrument[axis] = static_cast<std::uint8_t>(cluster.instrument[axis]);
    }
    return nominal;
}

Recorded recorded(double moving_s, std::uint64_t seed)
{
    const auto cluster = geometry::layout("triads-3").value();
    Recorded result{.nominal = nominal_of(cluster), .samples = {}};
    std::mt19937_64 random(seed);
    std::normal_distribution<double> normal;
    const std::size_t count = 1313 + static_cast<std::size_t>(moving_s / interval_s);
    for (std::size_t i = 0; i < count; ++i) {
        const double time_s = static_cast<double>(i + 1) * interval_s;
        const bool moves = (i >= 625 && i < 688) || i >= 1313;
        calibration::Sample sample{.time_s = time_s, .interval_s = interval_s, .rate = geometry::AxisVector::Zero(9)};
        for (Eigen::Index instrument = 0; instrument < 3; ++instrument) {
            const Eigen::Vector3d rate = moves ? rate_at(time_s + jitter_s * normal(random)) : Eigen::Vector3d::Zero();
            for (Eigen::Index axis = 3 * instrument; axis < 3 * instrument + 3; ++axis)
                sample.rate(axis) = cluster.axes.row(axis).dot(rate) + 0.2 * degree * normal(random);
        }
        result.samples.push_back(sample);
    }
    return result;
}

TEST(HeldOut, halves_share_the_motion_and_are_calibrated_without_what_they_play)
{
    const Recorded log = recorded(30, 1);
    const auto halves = calibration::held_out_halves(log.samples, log.nominal, log.rest);
    ASSERT_EQ(halves.size(), 2U);
    std::set<std::size_t> played;
    for (const HeldOut& half : halves)
        for (const auto& stretch : half.stretches)
            for (std::size_t i = stretch.begin; i < stretch.end; ++i) EXPECT_TRUE(played.insert(i).second) << i << " is played twice";
    EXPECT_EQ(played.size(), log.samples.size() - 1250) << "all that does not rest";

    // What one half alone measures wrongly does not reach its own calibration, but the other half's.
    Recorded wrong = log;
    for (const auto& stretch : halves[0].stretches)
        for (std::size_t i = stretch.begin; i < stretch.end; ++i) wrong.samples[i].rate(4) *= 1.05;
    const auto again = calibration::held_out_halves(wrong.samples, wrong.nominal, wrong.rest);
    ASSERT_EQ(again.size(), 2U);
    EXPECT_EQ(again[0].calibration.gain, halves[0].calibration.gain);
    EXPECT_GT(again[1].calibration.gain[4], halves[1].calibration.gain[4] + 0.02);
}

TEST(HeldOut, has_no_halves_where_one_of_them_does_not_turn_enough_to_show_the_axes)
{
    const Recorded log = recorded(0, 1);
    EXPECT_TRUE(calibration::held_out_halves(log.samples, log.nominal, log.rest).empty());
}

TEST(TightestSilent, tells_smaller_steps_than_terms_that_are_too_large_and_stays_silent)
{
    const Recorded log = recorded(20, 2);
    const auto halves = calibration::held_out_halves(log.samples, log.nominal, log.rest);
    ASSERT_EQ(halves.size(), 2U);
    const std::vector<HeldOut> half{halves[0]};
    const auto start = fdi::usual_motion_noise(half[0].cluster, 8);
    const Standing before = standing(log.samples, half, start);
    ASSERT_LT(before.largest_statistic, 0.85);
    const auto found = tightest_silent(log.samples, half, start);
    const Standing after = standing(log.samples, half, found);
    EXPECT_LE(after.largest_statistic, 0.86);
    EXPECT_LT(after.smallest_step_rad_s, before.smallest_step_rad_s / 2);
    EXPECT_EQ(found.bias_floor_rad_s, start.bias_floor_rad_s);
}

TEST(TightestSilent, silences_terms_that_are_too_small)
{
    const Recorded log = recorded(20, 3);
    const auto halves = calibration::held_out_halves(log.samples, log.nominal, log.rest);
    ASSERT_EQ(halves.size(), 2U);
    const std::vector<HeldOut> half{halves[1]};
    const auto start = fdi::usual_motion_noise(half[0].cluster, 0.1);
    ASSERT_GT(standing(log.samples, half, start).largest_statistic, 1);
    EXPECT_LE(standing(log.samples, half, tightest_silent(log.samples, half, start)).largest_statistic, 0.86);
}

TEST(GatedTerms, are_what_most_frames_show_and_not_the_worst)
{
    Recorded log = recorded(120, 4);
    const auto terms_of = [](const Recorded& shown) {
        return calibration::gated_terms(shown.samples, shown.nominal, calibration::calibrate(shown.samples, shown.nominal).value());
    };
    const auto terms = terms_of(log);
    ASSERT_TRUE(terms);
    EXPECT_GT(terms->jitter_along_s, jitter_s / 2);
    EXPECT_LT(terms->jitter_along_s, 2 * jitter_s);
    EXPECT_LT(terms->jitter_across_s, jitter_s / 2);
    for (std::size_t i = 1400; i < log.samples.size(); i += 400) log.samples[i].rate(5) += 10 * degree;
    const auto among_outliers = terms_of(log);
    ASSERT_TRUE(among_outliers);
    EXPECT_LT(among_outliers->jitter_along_s, 2 * jitter_s);
}

TEST(GatedTerms, are_not_told_by_a_recording_that_never_turned)
{
    const Recorded log = recorded(0, 5);
    EXPECT_FALSE(calibration::gated_terms(log.samples, log.nominal, calibration::calibrate(log.samples, log.nominal).value()));
}

}  // namespace
}  // namespace quorient::studies
