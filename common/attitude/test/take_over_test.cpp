#include "an_integrator.hpp"
#include "quorient/messages/exclusions.hpp"
#include "quorient/messages/meaning.hpp"

#include <gtest/gtest.h>

namespace quorient::attitude {
namespace {

using namespace testing;

VotedAttitude voted_at(const Instrument& instrument, std::uint64_t sequence)
{
    VotedAttitude voted;
    voted.epoch = 1;
    voted.sequence = sequence;
    voted.attitude = to_array(instrument.attitude_after(sequence));
    voted.angle_sigma_rad = 1e-4;
    voted.isolated_mask = axis_bit(2);
    voted.excluded_from = Exclusions{};
    voted.excluded_from[2] = 5;
    voted.reset_counter = 7;
    return voted;
}

TEST_F(AnIntegrator, that_restarts_takes_over_the_voted_attitude_and_its_exclusions)
{
    for (const bool seed_first : {true, false}) {
        Instrument running(cluster, motion);
        for (int i = 0; i < 100; ++i) running.next();
        IntegratorSettings settings;
        settings.initialised = false;
        CheckedIntegrator fresh = CheckedIntegrator::make(settings, cluster);
        if (seed_first) fresh.on_voted(voted_at(running, 99));
        EXPECT_EQ(mode_of(fresh.state()), AttitudeMode::initialising);
        for (int i = 0; i < 20; ++i) {
            fresh.add(running.next());
            EXPECT_EQ(mode_of(fresh.state()), seed_first ? AttitudeMode::normal : AttitudeMode::initialising) << i;
        }
        if (!seed_first) fresh.on_voted(voted_at(running, 110));  // in the middle of what it has received: catches up
        const auto state = fresh.publish();
        EXPECT_EQ(mode_of(state), AttitudeMode::normal);
        EXPECT_EQ(state.seeded, 1);
        EXPECT_EQ(state.sequence, 119u);
        EXPECT_EQ(state.isolated_mask, axis_bit(2));
        EXPECT_EQ(state.used_mask, cluster.all() & ~axis_bit(2));
        EXPECT_EQ(state.reset_counter, 7u);
        EXPECT_LT(angle_to(state, running.attitude_after(119)), 1e-6);
        EXPECT_GT(state.angle_sigma_rad, 1e-4);
    }
}

/// Takes over the exclusion of axis 2, which has been bad since frame 5, from the attitude voted at frame 110; its detector knows nothing
/// of it.
class ATakeOver : public AnIntegrator {
protected:
    ATakeOver()
    {
        instrument.set_fault(2, 5, [](double increment, double) { return increment * 1.5; });
        for (int i = 0; i < 100; ++i) instrument.next();
        for (int i = 0; i < 20; ++i) add(VerdictState::suspect);
        fresh.on_voted(voted_at(instrument, 110));
    }

    void add(VerdictState state)
    {
        const SensorFrame frame = instrument.next();
        fresh.add(frame);
        fresh.apply(verdict_on(frame.sequence, state));
    }

    /// Two other lanes stand behind an attitude that isolates all axes but these.
    void voters_let_go(AxisMask axes)
    {
        VotedAttitude voted = voted_at(instrument, 119);
        voted.primary_lane = 1;
        voted.level = octet(VoteLevel::degraded);
        voted.isolated_mask = cluster.all() & ~axes;
        voted.excluded_from.exclude(voted.isolated_mask, 5);
        voted.excluded_from.readmit(axes);
        fresh.on_voted(voted);
    }

    static IntegratorSettings waiting()
    {
        IntegratorSettings settings;
        settings.initialised = false;
        return settings;
    }

    CheckedIntegrator fresh = CheckedIntegrator::make(waiting(), cluster);
};

TEST_F(ATakeOver, is_not_undone_by_a_detector_that_was_away_at_the_onset)
{
    EXPECT_EQ(fresh.state().isolated_mask, axis_bit(2)) << "by verdicts that came before it";
    for (const auto state : {VerdictState::suspect, VerdictState::ambiguous, VerdictState::healthy}) add(state);
    fresh.apply(verdict_on(125, VerdictState::suspect));  // before its frame
    for (int i = 0; i < 10; ++i) fresh.add(instrument.next());
    EXPECT_EQ(fresh.state().isolated_mask, axis_bit(2));
    EXPECT_EQ(fresh.state().used_mask, cluster.all() & ~axis_bit(2));
    EXPECT_EQ(mode_of(fresh.state()), AttitudeMode::normal);
    EXPECT_LT(angle_to(fresh.state(), instrument.attitude_after(132)), 1e-6);
}

TEST_F(ATakeOver, is_undone_by_a_detector_that_had_found_the_fault_itself)
{
    fresh.apply(isolating(119, 2, 5));
    add(VerdictState::suspect);
    EXPECT_EQ(fresh.state().isolated_mask, 0u);
}

TEST_F(ATakeOver, is_undone_by_its_detector_once_the_voters_have_let_it_go)
{
    voters_let_go(axis_bit(1));
    add(VerdictState::healthy);
    EXPECT_EQ(fresh.state().isolated_mask, axis_bit(2));
    voters_let_go(axis_bit(2));
    add(VerdictState::healthy);
    EXPECT_EQ(fresh.state().isolated_mask, 0u);
}

TEST_F(AnIntegrator, whose_seed_does_not_connect_waits_for_another)
{
    IntegratorSettings settings;
    settings.initialised = false;
    CheckedIntegrator fresh = CheckedIntegrator::make(settings, cluster);
    for (int i = 0; i < 50; ++i) instrument.next();
    fresh.on_voted(voted_at(instrument, 40));  // frames 41 .. 49 will never come
    fresh.add(instrument.next());
    EXPECT_EQ(mode_of(fresh.state()), AttitudeMode::initialising);
    fresh.on_voted(voted_at(instrument, 52));  // its frame is still to come
    fresh.add(instrument.next());
    EXPECT_EQ(mode_of(fresh.state()), AttitudeMode::initialising);
    fresh.add(instrument.next());
    fresh.add(instrument.next());
    EXPECT_EQ(mode_of(fresh.state()), AttitudeMode::normal);
    EXPECT_LT(angle_to(fresh.state(), instrument.attitude_after(53)), 3e-6);
}

}  // namespace
}  // namespace quorient::attitude
