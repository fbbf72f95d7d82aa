// What a detector takes over from those who lived while it did not, and what it must not take.

#include "../../test/rig.hpp"
#include "detector_service.hpp"
#include "quorient/messages/meaning.hpp"

#include <gtest/gtest.h>
#include <optional>

namespace quorient::detector {

namespace {

using test::Rig;

constexpr AxisMask axis_1 = axis_bit(1);
constexpr std::uint64_t onset = 40;

class TakeOver : public testing::Test {
protected:
    void start() { detector.emplace(rig, rig.system.lanes.front().detector); }
    void frames(unsigned count) { rig.frames(count, *detector); }

    void run_until_it_judges()
    {
        do frames(1);
        while (state_of(rig.verdict()) == VerdictState::warming_up);
    }

    template <class State>
    State excluding(AxisMask axes, std::uint64_t from, std::uint64_t epoch = Rig::first_epoch) const
    {
        State state;
        state.epoch = epoch;
        state.sequence = rig.next_sequence();
        state.unit = rig.system.unit;
        state.isolated_mask = axes;
        for (std::size_t axis = 0; axis < max_axes; ++axis) state.excluded_from[axis] = has_axis(axes, axis) ? from : never;
        return state;
    }

    void lane_remembers(AxisMask axes, std::uint64_t from = onset, std::uint64_t epoch = Rig::first_epoch)
    {
        auto attitude = excluding<AttitudeState>(axes, from, epoch);
        attitude.lane = rig.system.lanes.front().detector.lane;
        rig.publish(bus::topics::attitude, attitude);
    }

    void voters_stand_for(AxisMask axes, VoteLevel level, std::uint64_t from = onset)
    {
        auto voted = excluding<VotedAttitude>(axes, from);
        voted.level = octet(level);
        rig.publish(bus::topics::voter_output, voted);
    }

    void order_readmission()
    {
        FaultCommand command;
        command.unit = rig.system.unit;
        command.action = octet(CommandAction::readmit);
        command.axes = axis_1;
        command.request = 9;
        rig.publish(bus::topics::command, command);
        rig.run(*detector);
    }

    Rig rig;
    std::optional<Rig::Process<DetectorService>> detector;
};

TEST_F(TakeOver, of_what_the_lane_remembers_keeps_a_fault_that_shows_no_more)
{
    start();
    frames(40);
    rig.inject("axis=1,kind=bias,value=0.1,start=0.2");
    frames(20);
    ASSERT_EQ(rig.verdict().isolated_mask, axis_1);
    const auto from = rig.verdict().excluded_from[1];

    detector.reset();
    rig.heal();
    lane_remembers(axis_1, from);
    start();
    run_until_it_judges();
    EXPECT_EQ(rig.verdict().isolated_mask, axis_1);
    EXPECT_EQ(rig.verdict().excluded_from[1], from) << "contaminated since then, not since the restart";
    EXPECT_EQ(rig.verdict().adopted, 1);
}

TEST_F(TakeOver, takes_nothing_where_nobody_remembers_anything)
{
    start();
    lane_remembers(0);
    voters_stand_for(0, VoteLevel::full);
    frames(100);
    EXPECT_EQ(rig.verdict().isolated_mask, 0U);
    EXPECT_EQ(rig.verdict().adopted, 0);
}

TEST_F(TakeOver, takes_nothing_from_another_lane_or_another_unit)
{
    start();
    auto other = excluding<AttitudeState>(axis_1, onset);
    other.lane = rig.system.lanes.back().detector.lane;
    rig.publish(bus::topics::attitude, other);
    auto foreign = excluding<AttitudeState>(axis_1, onset);
    foreign.lane = rig.system.lanes.front().detector.lane;
    foreign.unit = rig.system.unit + 1;
    rig.publish(bus::topics::attitude, foreign);
    frames(100);
    EXPECT_EQ(rig.verdict().isolated_mask, 0U);
}

TEST_F(TakeOver, of_what_a_majority_of_lanes_stands_for_finds_what_happened_while_it_was_dead)
{
    start();
    frames(3);
    voters_stand_for(axis_1, VoteLevel::degraded);
    run_until_it_judges();
    EXPECT_EQ(rig.verdict().isolated_mask, axis_1);
}

TEST_F(TakeOver, believes_no_single_lane_and_no_voter_that_is_lost)
{
    start();
    frames(3);
    for (const auto level : {VoteLevel::single, VoteLevel::coasting, VoteLevel::lost, VoteLevel::unknown}) {
        voters_stand_for(axis_1, level);
        frames(1);
    }
    frames(100);
    EXPECT_EQ(rig.verdict().isolated_mask, 0U);
}

TEST_F(TakeOver, ends_with_its_own_first_judgement)
{
    start();
    run_until_it_judges();
    lane_remembers(axis_1);
    voters_stand_for(axis_1, VoteLevel::full, 2);
    frames(100);
    EXPECT_EQ(rig.verdict().isolated_mask, 0U) << "what it has seen with its own eyes it judges itself";
}

TEST_F(TakeOver, does_not_bring_back_what_an_order_has_readmitted)
{
    start();
    lane_remembers(axis_1);
    frames(3);
    ASSERT_EQ(rig.verdict().isolated_mask, axis_1);
    order_readmission();
    lane_remembers(axis_1);  // said before the order reached the lane
    voters_stand_for(axis_1, VoteLevel::full);
    frames(100);
    EXPECT_EQ(rig.verdict().isolated_mask, 0U);
    ASSERT_EQ(rig.answers(9).size(), 1U);
    EXPECT_EQ(rig.answers(9).front().code, octet(EventCode::command_done));
}

TEST_F(TakeOver, obeys_an_order_that_comes_before_it_knows_of_any_exclusion)
{
    start();
    order_readmission();
    ASSERT_EQ(rig.answers(9).size(), 1U);
    EXPECT_EQ(rig.answers(9).front().code, octet(EventCode::command_done));
    lane_remembers(axis_1);
    frames(100);
    EXPECT_EQ(rig.verdict().isolated_mask, 0U);
}

TEST_F(TakeOver, refuses_to_readmit_what_it_judges_healthy)
{
    start();
    run_until_it_judges();
    order_readmission();
    ASSERT_EQ(rig.answers(9).size(), 1U);
    EXPECT_EQ(rig.answers(9).front().code, octet(EventCode::command_refused));
}

TEST_F(TakeOver, obeys_a_repeated_order_once)
{
    start();
    lane_remembers(axis_1);
    frames(3);
    order_readmission();
    order_readmission();
    EXPECT_EQ(rig.answers(9).size(), 1U);
}

TEST_F(TakeOver, of_an_exclusion_of_another_epoch_holds_from_the_first_frame_of_this_one)
{
    lane_remembers(axis_1, 12345, Rig::first_epoch - 1);
    start();
    run_until_it_judges();
    EXPECT_EQ(rig.verdict().isolated_mask, axis_1);
    EXPECT_EQ(rig.verdict().excluded_from[1], 0U);
}

TEST_F(TakeOver, keeps_what_it_has_isolated_when_its_publisher_starts_again)
{
    start();
    lane_remembers(axis_1);
    run_until_it_judges();
    rig.pass_time(1'000'000'000);
    rig.begin_epoch(Rig::first_epoch + 1);
    frames(60);
    EXPECT_EQ(rig.verdict().epoch, Rig::first_epoch + 1);
    EXPECT_EQ(rig.verdict().isolated_mask, axis_1);
    EXPECT_EQ(rig.verdict().excluded_from[1], 0U);
}

TEST_F(TakeOver, of_a_fault_that_began_while_it_was_cut_off_follows_the_majority)
{
    start();
    run_until_it_judges();
    const auto first_lost = rig.next_sequence();
    rig.lose(100);
    frames(1);
    voters_stand_for(axis_1, VoteLevel::full, first_lost + 50);
    frames(2);
    EXPECT_EQ(rig.verdict().isolated_mask, axis_1);
    EXPECT_EQ(rig.verdict().excluded_from[1], first_lost + 50);
}

TEST_F(TakeOver, of_a_fault_that_began_before_it_started_comes_late_and_counts_nevertheless)
{
    start();
    frames(100);
    detector.reset();
    start();
    run_until_it_judges();
    voters_stand_for(axis_1, VoteLevel::full, 60);
    frames(2);
    EXPECT_EQ(rig.verdict().isolated_mask, axis_1) << "a voter found only after the first judgement";
}

TEST_F(TakeOver, of_a_fault_that_began_after_it_started_follows_nobody)
{
    start();
    frames(100);
    detector.reset();
    start();
    frames(100);
    voters_stand_for(axis_1, VoteLevel::full, 150);
    frames(50);
    EXPECT_EQ(rig.verdict().isolated_mask, 0U) << "it saw those frames itself";
}

TEST_F(TakeOver, of_a_fault_that_began_long_before_it_was_cut_off_follows_nobody)
{
    start();
    frames(100);
    rig.lose(100);
    frames(1);
    voters_stand_for(axis_1, VoteLevel::full, 50);
    frames(50);
    EXPECT_EQ(rig.verdict().isolated_mask, 0U) << "it saw those frames itself";
}

}  // namespace

}  // namespace quorient::detector
