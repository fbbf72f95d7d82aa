// Axes that are left out for a time, and used again once they agree with the others.

#include "checked_integrator.hpp"
#include "quorient/messages/meaning.hpp"
#include "quorient/messages/words.hpp"

#include <gtest/gtest.h>
#include <algorithm>
#include <cmath>

namespace quorient::attitude {
namespace {

using namespace testing;

constexpr double interval_s = 0.005;
constexpr std::size_t axis = 2;
constexpr std::uint64_t onset = 70;  // the beginning of the window that contradicts
constexpr std::uint64_t found = 75;  // first verdict that leaves the axis out
constexpr std::uint64_t end = 130;   // first verdict without it
constexpr std::uint64_t last = 199;
constexpr double bias_rad = 1e-3;  // the disturbance from `onset` on, 8 frames long
constexpr std::uint64_t disturbed_frames = 8;
const ClassicConing motion(20, 2);

FaultVerdict leaving_out(std::uint64_t sequence, AxisMask axes, std::uint64_t from)
{
    FaultVerdict verdict = verdict_on(sequence, VerdictState::provisional);
    verdict.excluded_from.exclude(axes, from);
    return verdict;
}

FaultVerdict passing(std::uint64_t sequence)
{
    return sequence >= found && sequence < end ? leaving_out(sequence, axis_bit(axis), onset) : verdict_on(sequence);
}

class ADisturbance : public ::testing::Test {
protected:
    ADisturbance()
    {
        instrument.set_fault(axis, onset, [](double z, std::uint64_t frame) { return frame < disturbed_frames ? z + bias_rad : z; });
        frames = record(instrument, last + 1);
    }

    double error(const AttitudeState& state) const { return angle_to(state, instrument.attitude_after(state.sequence)); }

    geometry::SensorCluster cluster = cluster_of("cone-6", interval_s, 1e-6);
    Instrument instrument{cluster, motion};
    std::vector<SensorFrame> frames;
};

TEST_F(ADisturbance, is_integrated_again_from_the_windows_beginning_and_leaves_nothing_behind)
{
    CheckedIntegrator integrator = integrator_for(cluster, motion);
    CheckedIntegrator uncorrected = integrator_for(cluster, motion, 1, false);
    for (const auto& frame : frames) {
        for (CheckedIntegrator* each : {&integrator, &uncorrected}) {
            each->apply(passing(frame.sequence));
            each->add(frame);
        }
        const AttitudeState state = integrator.publish();
        const bool out = frame.sequence >= found && frame.sequence < end;
        ASSERT_EQ(state.isolated_mask, 0u) << "an axis that may return is not isolated, frame " << frame.sequence;
        ASSERT_EQ(provisional_mask(state), out ? axis_bit(axis) : 0u) << "frame " << frame.sequence;
        ASSERT_EQ(state.used_mask, out ? cluster.all() & ~axis_bit(axis) : cluster.all()) << "frame " << frame.sequence;
        ASSERT_EQ(mode_of(state), AttitudeMode::normal);
        ASSERT_EQ(state.reset_counter, frame.sequence >= found ? 1u : 0u) << "the correction is a reset, the return is none";
        if (frame.sequence >= found) {
            ASSERT_LT(error(state), 1e-9) << "frame " << frame.sequence;
        }
    }
    EXPECT_GT(error(uncorrected.state()), 1e-3) << "the disturbance is there";
}

TEST_F(ADisturbance, ends_with_a_verdict_that_leaves_out_another_axis_instead)
{
    CheckedIntegrator integrator = integrator_for(cluster, motion);
    for (const auto& frame : frames) {
        if (frame.sequence < 100) integrator.apply(passing(frame.sequence));
        else integrator.apply(leaving_out(frame.sequence, axis_bit(4), 100));
        integrator.add(frame);
    }
    EXPECT_EQ(integrator.state().used_mask, cluster.all() & ~axis_bit(4));
    EXPECT_EQ(provisional_mask(integrator.state()), axis_bit(4));
    EXPECT_LT(error(integrator.state()), 1e-9) << "the frames of the first exclusion stay without the first axis";
}

TEST_F(ADisturbance, does_not_end_while_the_detector_has_nothing_to_compare)
{
    for (const auto state : {VerdictState::saturated, VerdictState::blind, VerdictState::ambiguous, VerdictState::warming_up}) {
        CheckedIntegrator integrator = integrator_for(cluster, motion);
        for (std::uint64_t sequence = 0; sequence < 100; ++sequence) {
            integrator.apply(sequence < 90 ? passing(sequence) : verdict_on(sequence, state));
            integrator.add(frames[sequence]);
        }
        EXPECT_FALSE(has_axis(integrator.state().used_mask, axis)) << to_string(state);
        EXPECT_EQ(integrator.state().isolated_mask, 0u);
    }
}

TEST_F(ADisturbance, that_is_confirmed_is_isolated_without_another_correction)
{
    CheckedIntegrator integrator = integrator_for(cluster, motion);
    for (std::uint64_t sequence = 0; sequence < 110; ++sequence) {
        integrator.apply(sequence < 100 ? passing(sequence) : isolating(sequence, axis, onset));
        integrator.add(frames[sequence]);
        integrator.publish();
    }
    EXPECT_EQ(integrator.state().isolated_mask, axis_bit(axis));
    EXPECT_EQ(provisional_mask(integrator.state()), 0u);
    EXPECT_EQ(integrator.state().reset_counter, 1u);
    EXPECT_LT(error(integrator.state()), 1e-9);
}

TEST_F(ADisturbance, that_is_found_late_ends_as_if_it_had_been_found_at_once)
{
    CheckedIntegrator late = integrator_for(cluster, motion);
    CheckedIntegrator at_once = integrator_for(cluster, motion);
    for (const auto& frame : frames) {
        at_once.apply(frame.sequence >= onset && frame.sequence < found ? leaving_out(frame.sequence, axis_bit(axis), onset)
                                                                        : passing(frame.sequence));
        at_once.add(frame);
        late.add(frame);
        if (frame.sequence >= 3) late.apply(passing(frame.sequence - 3));
    }
    for (std::uint64_t sequence = last - 2; sequence <= last; ++sequence) late.apply(passing(sequence));
    finish(late);
    EXPECT_EQ(late.state().attitude, at_once.state().attitude);
    EXPECT_EQ(late.state().angle_sigma_rad, at_once.state().angle_sigma_rad);
}

TEST_F(ADisturbance, is_forgotten_when_a_new_epoch_finds_the_axis_sound)
{
    CheckedIntegrator integrator = integrator_for(cluster, motion);
    for (std::uint64_t sequence = 0; sequence < 100; ++sequence) {
        integrator.apply(passing(sequence));
        integrator.add(frames[sequence]);
    }
    for (std::uint64_t sequence = 0; sequence < 4; ++sequence) {
        SensorFrame frame = frames[sequence];
        frame.epoch = 2;
        FaultVerdict verdict = verdict_on(sequence, sequence < 2 ? VerdictState::warming_up : VerdictState::healthy);
        verdict.epoch = 2;
        integrator.apply(verdict);
        integrator.add(frame);
        EXPECT_EQ(has_axis(integrator.state().used_mask, axis), sequence >= 2) << "frame " << sequence;
    }
}

TEST_F(ADisturbance, is_not_taken_over_from_the_voters)
{
    IntegratorSettings settings;
    settings.initialised = false;
    CheckedIntegrator fresh = CheckedIntegrator::make(settings, cluster);
    VotedAttitude voted;
    voted.epoch = 1;
    voted.sequence = 79;
    voted.attitude = to_array(instrument.attitude_after(79));
    voted.level = octet(VoteLevel::full);
    voted.primary_lane = 1;
    voted.excluded_from[axis] = onset;  // and not isolated
    fresh.on_voted(voted);
    for (std::uint64_t sequence = 80; sequence < 100; ++sequence) {
        fresh.apply(verdict_on(sequence));
        fresh.add(frames[sequence]);
    }
    EXPECT_EQ(fresh.state().used_mask, cluster.all());
    EXPECT_LT(error(fresh.state()), 1e-9);
}

// A sound axis is left out and returns. What is published must not move by more than the noise of the axes left allows.
TEST(ProvisionalExclusion, of_a_sound_axis_moves_the_attitude_by_no_more_than_noise)
{
    constexpr double noise_rad = 1e-5;
    constexpr int seeds = 50;
    const auto cluster = cluster_of("triads-3", interval_s, noise_rad);
    double sum_of_squares = 0;
    for (std::uint64_t seed = 1; seed <= seeds; ++seed) {
        Instrument noisy(cluster, motion);
        noisy.set_noise(noise_rad, seed);
        CheckedIntegrator with = integrator_for(cluster, motion);
        CheckedIntegrator without = integrator_for(cluster, motion);
        double largest_step = 0;
        Quaternion apart = Quaternion::Identity();
        for (std::uint64_t sequence = 0; sequence <= last; ++sequence) {
            const SensorFrame frame = noisy.next();
            with.apply(passing(sequence));
            without.apply(verdict_on(sequence));
            with.add(frame);
            without.add(frame);
            const Quaternion now = from_array(without.publish().attitude).conjugate() * from_array(with.publish().attitude);
            largest_step = std::max(largest_step, angle_between(apart, now));
            apart = now;
        }
        EXPECT_LT(largest_step, 4.5 * noise_rad * std::sqrt(static_cast<double>(found - onset) / 6)) << "seed " << seed;
        const double angle = angle_between(Quaternion::Identity(), apart);
        sum_of_squares += angle * angle;
    }
    // Leaving out one of three parallel axes changes the mean's variance from 1/3 to 1/2 of one axis's. The two means have the difference
    // (a + b) / 2 - (a + b + c) / 3 = (a + b) / 6 - c / 3, whose variance is 1/6 of one axis's.
    const double expected = noise_rad * std::sqrt(static_cast<double>(end - onset) / 6);
    EXPECT_LT(std::sqrt(sum_of_squares / seeds), 1.4 * expected);
    EXPECT_GT(std::sqrt(sum_of_squares / seeds), 0.7 * expected) << "the axis was really left out";
}

}  // namespace
}  // namespace quorient::attitude
