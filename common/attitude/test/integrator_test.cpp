#include "allocation_count.hpp"
#include "an_integrator.hpp"
#include "quorient/messages/exclusions.hpp"
#include "quorient/messages/meaning.hpp"

#include <gtest/gtest.h>
#include <cmath>
#include <limits>
#include <vector>

namespace quorient::attitude {
namespace {

using namespace testing;

TEST_F(AnIntegrator, follows_the_truth_to_rounding_and_reports_rate_and_axes)
{
    for (int i = 0; i < 1000; ++i) {
        integrator.add(instrument.next());
        const double allowed = i < 9 ? 3e-6 : 1e-13;  // until the window is full
        ASSERT_LT(error(), allowed) << "frame " << i;
    }
    const auto state = integrator.publish();
    EXPECT_EQ(state.epoch, 1u);
    EXPECT_EQ(state.sequence, 999u);
    EXPECT_EQ(state.sample_time_ns, 10'000'000'000);
    EXPECT_EQ(state.used_mask, cluster.all());
    EXPECT_EQ(mode_of(state), AttitudeMode::normal);
    EXPECT_EQ(state.reset_counter, 0u);
    EXPECT_EQ(state.excluded_from, Exclusions{});
    const Eigen::Vector3d mean_rate = motion.increment(9.99L, 0.01L) / 0.01;
    for (std::size_t i = 0; i < 3; ++i) EXPECT_NEAR(state.rate_rad_s[i], mean_rate[static_cast<Eigen::Index>(i)], 1e-13);
}

TEST_F(AnIntegrator, before_its_first_frame_is_initialising)
{
    EXPECT_EQ(mode_of(integrator.state()), AttitudeMode::initialising);
    integrator.add(instrument.next());
    EXPECT_EQ(mode_of(integrator.state()), AttitudeMode::normal);
}

TEST_F(AnIntegrator, ignores_frames_that_are_not_newer)
{
    const SensorFrame first = instrument.next();
    integrator.add(first);
    integrator.add(instrument.next());
    const auto before = integrator.state();
    integrator.add(first);
    EXPECT_EQ(integrator.state().attitude, before.attitude);
    EXPECT_EQ(integrator.state().sequence, before.sequence);
}

TEST_F(AnIntegrator, loses_no_rotation_with_a_lost_frame)
{
    for (int lost : {1, 2, 5}) {
        for (int i = 0; i < 50; ++i) integrator.add(instrument.next());
        EXPECT_EQ(integrator.state().bridged, 0);
        const double sigma = integrator.state().angle_sigma_rad;
        SensorFrame frame = instrument.next();
        for (int i = 0; i < lost; ++i) frame = instrument.next();
        integrator.add(frame);
        EXPECT_EQ(integrator.state().bridged, 1);
        EXPECT_EQ(mode_of(integrator.state()), AttitudeMode::normal);
        EXPECT_LT(error(), lost <= 2 ? 1e-9 : 1e-6) << lost << " lost";
        EXPECT_GT(integrator.state().angle_sigma_rad, sigma + 1e-7) << "what is guessed in a gap is said";
    }
}

TEST_F(AnIntegrator, applies_the_coning_term_of_a_gap_and_covers_what_is_left_by_its_standard_deviation)
{
    const ClassicConing brisk(30, 4);
    for (int lost = 1; lost <= 20; ++lost) {
        Instrument shaken(cluster, brisk);
        CheckedIntegrator bridging = integrator_for(cluster, brisk);
        for (int i = 0; i < 50; ++i) bridging.add(shaken.next());
        const std::uint64_t before = bridging.state().sequence;
        SensorFrame frame;
        for (int i = 0; i <= lost; ++i) frame = shaken.next();
        bridging.add(frame);
        const double left = angle_to(bridging.state(), shaken.attitude_after(frame.sequence));
        EXPECT_LT(left, 3 * bridging.state().angle_sigma_rad) << lost << " lost";

        const Wide begin_s = static_cast<Wide>(before + 1) * interval_s;
        const Wide gap_s = static_cast<Wide>(lost) * interval_s;
        const double plain =
            angle_between(brisk.attitude(begin_s) * from_rotation_vector(brisk.increment(begin_s, gap_s)), brisk.attitude(begin_s + gap_s));
        EXPECT_TRUE(lost > 4 || left < 0.5 * plain) << lost << " lost: " << left << " of " << plain;
    }
}

TEST_F(AnIntegrator, bridges_a_gap_only_with_axes_that_missed_nothing_in_it)
{
    for (int i = 0; i < 20; ++i) integrator.add(instrument.next());
    instrument.next();
    SensorFrame frame = instrument.next();
    frame.missed[2] = 1;  // the instrument itself lost one sample of this axis in the gap
    frame.accumulated[2] -= 0.05;
    integrator.add(frame);
    EXPECT_LT(error(), 1e-9);
    EXPECT_EQ(integrator.state().used_mask, cluster.all()) << "its own increment of this frame is sound";
}

TEST_F(AnIntegrator, coasts_without_three_axes_then_is_lost_and_never_not_a_number)
{
    for (int i = 0; i < 20; ++i) integrator.add(instrument.next());
    const auto good = integrator.publish();
    FaultVerdict verdict = isolating(20, 0, 20);
    for (std::size_t axis = 0; axis < 4; ++axis) verdict.excluded_from[axis] = 20;
    integrator.apply(verdict);
    double sigma = good.angle_sigma_rad;
    for (int i = 0; i < 150; ++i) {
        integrator.add(instrument.next());
        const auto state = integrator.publish();
        EXPECT_EQ(state.attitude, good.attitude) << "held";
        EXPECT_GT(state.angle_sigma_rad, sigma) << "growing";
        if (i < 98 || i > 101) {  // 1 s, give or take rounding
            EXPECT_EQ(mode_of(state), i < 100 ? AttitudeMode::coasting : AttitudeMode::lost) << i;
        }
        EXPECT_EQ(state.used_mask, 0u);
        sigma = state.angle_sigma_rad;
    }
    EXPECT_LT(error(), 3 * sigma);
    integrator.apply(verdict_on(170));
    integrator.add(instrument.next());
    EXPECT_EQ(mode_of(integrator.state()), AttitudeMode::lost) << "what turned meanwhile stays unknown";
    ASSERT_TRUE(integrator.reset(to_array(instrument.attitude_after(170)), 170));
    integrator.add(instrument.next());
    EXPECT_EQ(mode_of(integrator.state()), AttitudeMode::normal);
    EXPECT_LT(error(), 3e-6);
}

TEST_F(AnIntegrator, that_coasted_wrongly_is_put_right_when_the_verdict_is_revised)
{
    for (int i = 0; i < 20; ++i) integrator.add(instrument.next());
    FaultVerdict wrong = isolating(20, 0, 15);
    for (std::size_t axis = 0; axis < 4; ++axis) wrong.excluded_from[axis] = 15;
    integrator.apply(wrong);
    integrator.add(instrument.next());
    EXPECT_EQ(mode_of(integrator.state()), AttitudeMode::coasting);
    integrator.apply(isolating(21, 0, 15));
    integrator.add(instrument.next());
    EXPECT_EQ(mode_of(integrator.state()), AttitudeMode::normal);
    // Axes 1 to 3 were cleared at frame 21: the frames before it stay without them.
    EXPECT_GT(integrator.state().angle_sigma_rad, 1e-3);
}

TEST_F(AnIntegrator, survives_values_that_no_intake_should_have_let_through)
{
    const double nan = std::numeric_limits<double>::quiet_NaN();
    for (int i = 0; i < 30; ++i) {
        SensorFrame frame = instrument.next();
        if (i == 10) frame.increment[0] = nan;
        if (i == 11) frame.increment[1] = std::numeric_limits<double>::infinity();
        if (i == 12) frame.increment[2] = 1e300;
        if (i == 13) frame.valid_mask = 0;
        if (i == 14) frame.accumulated[3] = nan;
        if (i == 15) continue;  // bridged with that
        integrator.add(frame);
        ASSERT_TRUE(std::isfinite(integrator.state().attitude[0])) << i;
        ASSERT_TRUE(std::isfinite(integrator.state().angle_sigma_rad)) << i;
    }
    EXPECT_LT(error(), 3 * integrator.state().angle_sigma_rad);
}

TEST_F(AnIntegrator, takes_intervals_from_frames_whatever_the_clock_does)
{
    for (int i = 0; i < 100; ++i) {
        SensorFrame frame = instrument.next();
        if (i >= 50) frame.sample_time_ns -= 3'600'000'000'000;
        if (i == 70) continue;
        integrator.add(frame);
    }
    EXPECT_LT(error(), 1e-9);
}

TEST(Integrator, refuses_settings_that_cannot_work_and_says_why)
{
    const auto cluster = cluster_of("cone-6", interval_s);
    const auto refusal = [](const IntegratorSettings& settings, const geometry::SensorCluster& c) {
        const auto made = Integrator::make(settings, c);
        return made ? std::string() : made.error();
    };
    EXPECT_EQ(refusal({}, cluster), "");
    EXPECT_NE(refusal({.algorithm = "window-99"}, cluster).find("window-N"), std::string::npos);
    EXPECT_NE(refusal({.history_s = 0}, cluster).find("history_s"), std::string::npos);
    EXPECT_NE(refusal({.history_s = 1e9}, cluster).find("250000"), std::string::npos);
    EXPECT_NE(refusal({.initial_attitude = {1, 1, 0, 0}}, cluster).find("unit quaternion"), std::string::npos);
    EXPECT_NE(refusal({.initial_attitude = {NAN, 0, 0, 0}}, cluster).find("unit quaternion"), std::string::npos);
    auto wrong = cluster;
    wrong.interval_s = 0;
    EXPECT_NE(refusal({}, wrong).find("interval"), std::string::npos);
    wrong = cluster;
    wrong.kind = SensorKind::accelerometer;
    EXPECT_NE(refusal({}, wrong).find("gyro"), std::string::npos);
}

TEST(Integrator, runs_every_algorithm_and_rolls_it_back)
{
    const auto cluster = cluster_of("cone-6", interval_s, 1e-6);
    for (const char* algorithm :
         {"single", "previous", "two-sample", "three-sample", "three-sample-miller", "four-sample", "block-8", "window-8"}) {
        IntegratorSettings settings;
        settings.algorithm = algorithm;
        settings.history_s = 0.5;
        settings.initial_attitude = to_array(motion.attitude(0));
        CheckedIntegrator late = CheckedIntegrator::make(settings, cluster);
        CheckedIntegrator at_once = CheckedIntegrator::make(settings, cluster);
        Instrument instrument(cluster, motion);
        instrument.set_fault(4, 63, [](double z, auto) { return z + 0.01; });
        for (const auto& frame : record(instrument, 103)) {
            if (frame.sequence >= 63) at_once.apply(isolating(frame.sequence, 4, 63));
            if (frame.sequence >= 97) late.apply(isolating(frame.sequence, 4, 63));
            late.add(frame);
            at_once.add(frame);
        }
        EXPECT_EQ(late.state().attitude, at_once.state().attitude) << algorithm;
        EXPECT_EQ(late.state().reset_counter, 1u) << algorithm;
        EXPECT_LT(angle_to(late.state(), instrument.attitude_after(102)), 2e-3) << algorithm;
    }
}

TEST(Integrator, allocates_nothing_after_it_was_made)
{
    const auto cluster = cluster_of("dodecahedron", interval_s, 1e-6);
    Instrument instrument(cluster, motion);
    instrument.set_fault(4, 100, [](double z, auto) { return z + 0.01; });
    const auto frames = record(instrument, 400);
    CheckedIntegrator integrator = integrator_for(cluster, motion, 1.5);
    const std::size_t before = test::allocation_count();
    for (const auto& frame : frames) {
        if (frame.sequence % 50 == 7) continue;  // gaps too
        integrator.apply(frame.sequence >= 200 ? isolating(frame.sequence, 4, 100)
                                               : suspecting(frame.sequence, axis_bit(frame.sequence % 6)));
        integrator.add(frame);
        integrator.publish();
    }
    EXPECT_EQ(test::allocation_count(), before);
    EXPECT_GT(integrator.state().reset_counter, 0u);
    EXPECT_NE(std::vector<int>(10).data(), nullptr);
    EXPECT_GT(test::allocation_count(), before) << "the counter counts";
}

// The published standard deviation against the root mean square of the true error, noise alone.
double sigma_ratio(const std::string& layout, AxisMask excluded, std::uint64_t seeds)
{
    constexpr double sigma_rad = 1e-4;
    auto cluster = cluster_of(layout, interval_s, sigma_rad);
    double squared = 0;
    double claimed = 0;
    for (std::uint64_t seed = 1; seed <= seeds; ++seed) {
        Instrument noisy(cluster, motion);
        noisy.set_noise(sigma_rad, seed);
        CheckedIntegrator integrator = integrator_for(cluster, motion);
        FaultVerdict verdict = verdict_on(0, VerdictState::isolated);
        for (std::size_t axis = 0; axis < cluster.size(); ++axis)
            if (has_axis(excluded, axis)) verdict.excluded_from[axis] = 100;
        integrator.apply(verdict);
        for (int i = 0; i < 300; ++i) integrator.add(noisy.next());
        const double error = angle_to(integrator.state(), noisy.attitude_after(299));
        squared += error * error;
        claimed = integrator.state().angle_sigma_rad;
    }
    return claimed / std::sqrt(squared / static_cast<double>(seeds));
}

TEST(StandardDeviation, is_that_of_the_noise_of_the_axes_really_used)
{
    EXPECT_NEAR(sigma_ratio("dodecahedron", 0, 2000), 1, 0.05);
    EXPECT_NEAR(sigma_ratio("dodecahedron", axis_bit(1), 2000), 1, 0.05);
    EXPECT_NEAR(sigma_ratio("cone-4", axis_bit(2), 2000), 1, 0.05);
}

}  // namespace
}  // namespace quorient::attitude
