#include "field/field_detector.hpp"

#include "field_scene.hpp"
#include "quorient/fdi/methods.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <algorithm>

namespace quorient::fdi {
namespace {

using ::testing::HasSubstr;

constexpr double onset_s = 12;
constexpr std::uint64_t onset = 1200;
constexpr double frame_s = 0.01;

std::unique_ptr<FieldDetector> detector_on(const FieldScene& scene, const DetectorSettings& settings = {}, const FieldRules& rules = {})
{
    return FieldDetector::make(settings, scene.cluster, rules).value();
}

double seconds_after(std::uint64_t sequence)
{
    return (static_cast<double>(sequence) - static_cast<double>(onset)) * frame_s;
}

/// From the onset on, this axis says something else.
auto spoil_from_onset(std::size_t axis, std::function<double(double)> fault)
{
    return [axis, fault = std::move(fault)](std::uint64_t sequence, FieldScene::Rates& rates) {
        if (sequence >= onset) rates[axis] = fault(rates[axis]);
    };
}

struct Fault {
    const char* name;
    std::function<double(double)> of;
    double provisional_within_s;
    double named_within_s;
};

std::ostream& operator<<(std::ostream& out, const Fault& fault)
{
    return out << fault.name;
}

class FieldFault : public ::testing::TestWithParam<Fault> {};

TEST_P(FieldFault, is_left_out_at_once_and_named_soon_on_every_axis_of_an_uncalibrated_array)
{
    const Fault& fault = GetParam();
    for (std::size_t axis = 0; axis < 9; ++axis) {
        SCOPED_TRACE("axis " + std::to_string(axis));
        FieldScene scene(3, 40 + axis);
        scene.spoil = spoil_from_onset(axis, fault.of);
        const auto detector = detector_on(scene);
        const Played result = play(scene, *detector, onset_s + 8);
        ASSERT_EQ(result.named, axes_of(axis / 3));
        EXPECT_GE(result.named_at, onset);
        EXPECT_LE(seconds_after(result.named_at), fault.named_within_s);
        const std::uint64_t left_out = std::min(result.provisional_at, result.named_at);
        EXPECT_GE(left_out, onset);
        EXPECT_LE(seconds_after(left_out), fault.provisional_within_s);
        EXPECT_LE(seconds_after(result.onset), std::max(0.02, fault.provisional_within_s - 0.05)) << "contaminated frames stay in the attitude";
    }
}

INSTANTIATE_TEST_SUITE_P(
    Of, FieldFault,
    ::testing::Values(Fault{"a_bias_of_2_deg_s", [](double rate) { return rate + 2; }, 1.0, 2.0},
                      Fault{"a_bias_of_5_deg_s", [](double rate) { return rate - 5; }, 0.12, 0.6},
                      Fault{"a_bias_of_23_deg_s", [](double rate) { return rate + 22.9; }, 0.07, 0.5},
                      Fault{"a_bias_of_60_deg_s", [](double rate) { return rate - 60; }, 0.07, 0.5},
                      Fault{"a_gain_of_0_8", [](double rate) { return 0.8 * rate; }, 0.6, 1.5},
                      Fault{"a_wrong_sign", [](double rate) { return -rate; }, 0.25, 1.5},
                      Fault{"zero", [](double) { return 0.0; }, 0.25, 1.5}),
    [](const auto& tested) { return tested.param.name; });

TEST(FieldDetector, blames_nobody_in_a_flight_of_uncalibrated_sound_instruments)
{
    for (std::uint64_t seed = 1; seed <= 12; ++seed) {
        SCOPED_TRACE("seed " + std::to_string(seed));
        Differences differences;
        differences.gain = seed % 3 == 0 ? 0.015 : 0.008;
        differences.quantum_deg_s = seed % 2 == 0 ? 0.5 : 0.061;
        differences.drift_deg_s = seed % 4 == 0 ? 0.02 : 0.004;
        FieldScene scene(seed % 5 == 0 ? 8 : 3, seed, differences);
        if (seed % 2 == 1) scene.motion = FieldScene::flight;  // no rest at the start
        const auto detector = detector_on(scene);
        const Played result = play(scene, *detector, 60);
        EXPECT_EQ(result.named, 0U);
        EXPECT_LE(result.provisional_frames, 90U) << "of 6000";
        EXPECT_LT(detector->largest_lasting(), 0.9);
    }
}

/// A start by hand: the array is shaken, and each instrument is shaken a little differently for the first second and a half.
void shake_at_the_start(FieldScene& scene)
{
    scene.motion = FieldScene::flight_after(4);
    scene.spoil = [&scene](std::uint64_t sequence, FieldScene::Rates& rates) {
        const double t = static_cast<double>(sequence) * frame_s;
        if (t >= 1.5) return;
        for (std::size_t axis = 0; axis < rates.size(); ++axis)
            rates[axis] += 3 * std::sin(2 * std::numbers::pi * (2.2 + 0.3 * static_cast<double>(axis / 3)) * t + static_cast<double>(axis));
    };
}

TEST(FieldDetector, compares_the_two_sound_ones_afresh_after_one_that_was_faulty_from_the_first_sample)
{
    for (std::uint64_t seed = 1; seed <= 8; ++seed) {
        SCOPED_TRACE("seed " + std::to_string(seed));
        FieldScene scene(3, seed);
        scene.mount(2, Eigen::AngleAxisd(2 * degree, Eigen::Vector3d(1, 1, -1).normalized()).toRotationMatrix());
        const geometry::Axes nominal = FieldScene(3, seed).cluster.axes;
        scene.cluster.axes = nominal;  // nobody knows of the 2 degrees
        shake_at_the_start(scene);
        const auto shaken = scene.spoil;
        scene.spoil = [&](std::uint64_t sequence, FieldScene::Rates& rates) {
            shaken(sequence, rates);
            rates[2] = 0.47 * rates[2] - 10.7;
            rates[1] += 9;
        };
        const auto detector = detector_on(scene);
        const Played result = play(scene, *detector, 30);
        EXPECT_EQ(result.named, axes_of(0));
        EXPECT_EQ(result.ambiguous_frames, 0U);
    }
}

TEST(FieldDetector, still_sees_the_two_that_are_left_disagree)
{
    FieldScene scene(3, 3);
    shake_at_the_start(scene);
    const auto shaken = scene.spoil;
    scene.spoil = [&](std::uint64_t sequence, FieldScene::Rates& rates) {
        shaken(sequence, rates);
        rates[2] = 0.47 * rates[2] - 10.7;
        if (sequence >= onset) rates[5] += 60;
    };
    const auto detector = detector_on(scene);
    const Played result = play(scene, *detector, onset_s + 5);
    EXPECT_EQ(result.named, axes_of(0));
    EXPECT_GT(result.ambiguous_frames, 250U);
    EXPECT_EQ(result.candidates, axes_of(1) | axes_of(2));
}

TEST(FieldDetector, names_each_of_two_faults_among_eight_instruments)
{
    FieldScene scene(8, 5);
    scene.spoil = [](std::uint64_t sequence, FieldScene::Rates& rates) {
        if (sequence >= onset) rates[4] += 10;
        if (sequence >= onset + 300) rates[20] *= 0.5;
    };
    const auto detector = detector_on(scene);
    EXPECT_EQ(play(scene, *detector, onset_s + 2).named, axes_of(1));
    EXPECT_EQ(play(scene, *detector, 6, axes_of(1)).named, axes_of(6));
}

TEST(FieldDetector, names_the_right_instrument_in_any_mounting)
{
    std::mt19937_64 random(7);
    std::normal_distribution<double> normal;
    for (std::size_t axis = 0; axis < 12; ++axis) {
        SCOPED_TRACE("axis " + std::to_string(axis));
        FieldScene scene(4, 60 + axis);
        for (std::size_t m = 0; m < 4; ++m)
            scene.mount(m, Eigen::Quaterniond(normal(random), normal(random), normal(random), normal(random)).normalized().toRotationMatrix());
        if (axis % 3 == 0) scene.spoil = spoil_from_onset(axis, [](double rate) { return rate + 5; });
        if (axis % 3 == 1) scene.spoil = spoil_from_onset(axis, [](double rate) { return 0.8 * rate; });
        if (axis % 3 == 2) scene.spoil = spoil_from_onset(axis, [](double rate) { return -rate; });
        const auto detector = detector_on(scene);
        const Played result = play(scene, *detector, onset_s + 8);
        EXPECT_EQ(result.named, axes_of(axis / 3));
        EXPECT_GE(result.named_at, onset);
        EXPECT_LE(seconds_after(result.named_at), 1.5);
    }
}

TEST(FieldDetector, never_names_an_instrument_for_a_shock_of_up_to_300_ms)
{
    for (std::uint64_t trial = 0; trial < 60; ++trial) {
        const double size = std::array{20.0, 60.0, 100.0, 150.0}[trial % 4];
        const std::uint64_t frames = std::array<std::uint64_t, 5>{1, 4, 8, 16, 30}[trial % 5];
        SCOPED_TRACE(std::to_string(size) + " deg/s for " + std::to_string(frames) + " frames, trial " + std::to_string(trial));
        FieldScene scene(3, 300 + trial);
        const std::size_t axis = trial % 9;
        scene.spoil = [=](std::uint64_t sequence, FieldScene::Rates& rates) {
            if (sequence >= onset && sequence < onset + frames) rates[axis] += size;
        };
        const auto detector = detector_on(scene);
        const Played result = play(scene, *detector, onset_s + 4);
        EXPECT_EQ(result.named, 0U);
        EXPECT_EQ(result.provisional & ~axes_of(axis / 3), 0U);
        const bool matters = size * static_cast<double>(frames) * frame_s > 2;
        EXPECT_TRUE(result.provisional != 0 || !matters) << "the attitude must not follow it";
    }
}

TEST(FieldDetector, names_an_instrument_whose_resting_bias_lies_outside_its_class)
{
    FieldScene scene(3, 3);
    scene.set_bias(1, 2, -11);
    const auto detector = detector_on(scene);
    const Played result = play(scene, *detector, 4);
    EXPECT_EQ(result.named, axes_of(1));
    EXPECT_LE(result.named_at, 101U);
    EXPECT_EQ(result.onset, 0U);

    FieldScene within(3, 3);
    within.set_bias(1, 2, -6);
    EXPECT_EQ(play(within, *detector_on(within), 30).named, 0U) << "sound consumer gyros have such biases";
}

TEST(FieldDetector, names_an_instrument_whose_samples_come_one_interval_late)
{
    FieldScene scene(3, 9);
    FieldScene::Rates last(9);
    scene.spoil = [&](std::uint64_t sequence, FieldScene::Rates& rates) {
        const FieldScene::Rates now = rates;
        for (std::size_t axis = 3; sequence >= onset && axis < 6; ++axis) rates[axis] = last[axis];
        last = now;
    };
    const auto detector = detector_on(scene);
    const Played result = play(scene, *detector, onset_s + 4);
    EXPECT_EQ(result.named, axes_of(1));
    EXPECT_GE(result.named_at, onset);
}

TEST(FieldDetector, finds_noise_that_no_window_shows)
{
    FieldScene scene(3, 11);
    std::mt19937_64 random(2);
    std::normal_distribution<double> noise(0, 4);
    scene.spoil = spoil_from_onset(7, [&](double rate) { return rate + noise(random); });
    const auto detector = detector_on(scene);
    const Played result = play(scene, *detector, onset_s + 5);
    EXPECT_EQ(result.named, axes_of(2));
    EXPECT_GE(result.named_at, onset);
}

TEST(FieldDetector, names_one_that_slowly_drifts_out_of_its_class)
{
    FieldScene scene(3, 12);
    double drift = 0;
    scene.spoil = spoil_from_onset(4, [&](double rate) { return rate + (drift += 0.1 * frame_s); });  // 0.1 deg/s per second
    const Played result = play(scene, *detector_on(scene), onset_s + 60);
    EXPECT_EQ(result.named, axes_of(1));
    EXPECT_GE(result.named_at, onset);
}

TEST(FieldDetector, tells_that_all_are_beyond_their_range_and_blames_nobody)
{
    FieldScene scene(3, 13);
    scene.motion = [](double t) -> Eigen::Vector3d {
        return FieldScene::flight(t) + Eigen::Vector3d(0, 0, t > 8 && t < 15 ? 3000 * std::sin(std::numbers::pi * (t - 8) / 7) : 0);
    };
    const auto detector = detector_on(scene);
    EXPECT_EQ(play(scene, *detector, 8).saturated_frames, 0U);
    const Played result = play(scene, *detector, 15);
    EXPECT_EQ(result.named, 0U);
    EXPECT_GT(result.saturated_frames, 300U);
}

TEST(FieldDetector, names_one_that_is_at_its_range_alone)
{
    FieldScene scene(3, 14);
    scene.spoil = spoil_from_onset(2, [](double) { return FieldScene::range_deg_s; });
    const Played result = play(scene, *detector_on(scene), onset_s + 2);
    EXPECT_EQ(result.named, axes_of(0));
    EXPECT_EQ(result.saturated_frames, 0U);
}

/// A turn of 600 deg/s about z from 8 s to 12 s; the first instrument measures 300 deg/s at most.
FieldScene scene_of_unequal_ranges(std::size_t instruments, std::uint64_t seed)
{
    static constexpr double smaller_deg_s = 300;
    FieldScene scene(instruments, seed);
    scene.motion = [](double t) -> Eigen::Vector3d {
        return FieldScene::flight(t) + Eigen::Vector3d(0, 0, t > 8 && t < 12 ? 600 * std::sin(std::numbers::pi * (t - 8) / 4) : 0);
    };
    scene.spoil = [](std::uint64_t, FieldScene::Rates& rates) {
        for (std::size_t axis = 0; axis < 3; ++axis) rates[axis] = std::clamp(rates[axis], -smaller_deg_s, smaller_deg_s);
    };
    scene.cluster.range.head(3).setConstant(smaller_deg_s * degree);
    return scene;
}

TEST(FieldDetector, leaves_an_instrument_out_while_the_others_measure_more_than_its_range)
{
    std::uint64_t begins = 800;
    while (scene_of_unequal_ranges(2, 15).motion(static_cast<double>(begins) * frame_s).z() < 300) ++begins;
    for (const std::size_t instruments : {2U, 3U, 8U}) {
        FieldScene scene = scene_of_unequal_ranges(instruments, 15);
        const auto detector = detector_on(scene);
        EXPECT_EQ(play(scene, *detector, 8).provisional, 0U);
        const Played turning = play(scene, *detector, 3.2);
        EXPECT_EQ(turning.provisional, axes_of(0)) << instruments;
        EXPECT_NEAR(static_cast<double>(turning.provisional_from), static_cast<double>(begins), 4) << instruments;
        EXPECT_EQ(turning.diagnosis[2].kind, Diagnosis::saturated);
        EXPECT_GT(turning.provisional_frames, 250U) << "the turn is beyond 300 deg/s for 2.7 s";
        const Played after = play(scene, *detector, 1.8);
        EXPECT_EQ(turning.named | after.named, 0U);
        EXPECT_LT(after.provisional_frames, 80U) << "half a second after the turn, and it is back";
    }
}

TEST(FieldDetector, leaves_nobody_out_while_some_of_equal_ranges_reach_theirs_before_the_others)
{
    for (const std::size_t instruments : {3U, 8U}) {
        FieldScene scene(instruments, 18, {.gain = 0.012});
        // So slowly to the range and back that gains decide for a while which instruments are near it.
        scene.motion = [](double t) -> Eigen::Vector3d {
            return FieldScene::flight(t) +
                   Eigen::Vector3d(0, 0, t > 8 && t < 28 ? FieldScene::range_deg_s * std::sin(std::numbers::pi * (t - 8) / 20) : 0);
        };
        unsigned near_range = 0;
        unsigned unanimous = 0;
        const auto detector = detector_on(scene);
        Assessment assessment;
        while (scene.time_s() < 31) {
            const Measurement measurement = scene.next();
            std::size_t near = 0;
            for (std::size_t m = 0; m < instruments; ++m)
                near += std::abs(measurement.increment[3 * m + 2]) > 0.975 * FieldScene::range_deg_s * degree * frame_s ? 1 : 0;
            near_range += near > 0 ? 1U : 0U;
            unanimous += near == instruments ? 1U : 0U;
            detector->assess(measurement, assessment);
            ASSERT_EQ(assessment.provisional, 0U) << "at " << scene.time_s() << " s";
        }
        EXPECT_GT(near_range, unanimous + 10) << "the scene has no frame in which only some are at their range";
    }
}

TEST(FieldDetector, names_an_instrument_that_ends_below_the_range_that_is_stated)
{
    FieldScene scene = scene_of_unequal_ranges(3, 15);
    scene.cluster.range.setConstant(FieldScene::range_deg_s * degree);
    const Played result = play(scene, *detector_on(scene), 13);
    EXPECT_EQ(result.named, axes_of(0));
    EXPECT_GT(result.named_at, 800U) << "not before the turn";
}

TEST(FieldDetector, says_of_two_instruments_that_they_disagree_and_never_which_is_wrong)
{
    FieldScene scene(2, 15);
    scene.spoil = spoil_from_onset(1, [](double rate) { return rate + 40; });
    const auto detector = detector_on(scene);
    EXPECT_EQ(play(scene, *detector, onset_s).ambiguous_frames, 0U);
    const Played result = play(scene, *detector, 3);
    EXPECT_EQ(result.named, 0U);
    EXPECT_EQ(result.provisional, 0U);
    EXPECT_GT(result.ambiguous_frames, 250U);
    EXPECT_EQ(result.candidates, axes_of(0) | axes_of(1));
}

TEST(FieldDetector, refuses_what_it_cannot_compare)
{
    FieldScene one(1, 1);
    EXPECT_THAT(FieldDetector::make({}, one.cluster).error(), HasSubstr("two or more instruments"));
    FieldScene three(3, 1);
    three.cluster.interval_s = 0;
    EXPECT_THAT(FieldDetector::make({}, three.cluster).error(), HasSubstr("interval_s"));
    three.cluster.interval_s = 0.01;
    EXPECT_THAT(FieldDetector::make({.delay_class_s = -1.0}, three.cluster).error(), HasSubstr("delay class"));
    EXPECT_TRUE(make_detector({.method = "field"}, three.cluster));
}

}  // namespace
}  // namespace quorient::fdi
