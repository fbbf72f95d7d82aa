#include "axis_state.hpp"

#include "ticks.hpp"

#include <gtest/gtest.h>

using namespace quorient;
using namespace quorient::monitor;

namespace {

Tick tick_of(const VotedAttitude& voted, const FaultVerdict& verdict)
{
    Collector collector{test::demo()};
    collector.on_description(test::description());
    collector.on_voted(voted, 1);
    collector.on_verdict(verdict, 1);
    return collector.tick(1, 1);
}

}  // namespace

TEST(AxisState, follows_the_voted_attitude_where_there_is_one)
{
    const auto tick = tick_of(test::voted(5, 0b0010), test::verdict(5, VerdictState::isolated, 0b0100));
    EXPECT_EQ(state_in_system(tick, 3, 1), AxisState::isolated);
    EXPECT_EQ(state_in_system(tick, 3, 2), AxisState::healthy) << "one lane alone does not decide";
    EXPECT_EQ(state_in_lane(tick.lane[0], 2), AxisState::isolated);
    EXPECT_EQ(state_in_system(tick, 3, 0), AxisState::healthy);
}

TEST(AxisState, follows_the_detectors_where_there_is_no_output)
{
    auto tick = tick_of(test::voted(5), test::verdict(5, VerdictState::isolated, 0b0100));
    tick.voted_fresh = false;
    EXPECT_EQ(state_in_system(tick, 3, 2), AxisState::isolated);
    EXPECT_EQ(state_in_system(tick, 3, 0), AxisState::healthy);
    tick.lane[0].fresh = false;
    EXPECT_EQ(state_in_system(tick, 3, 2), AxisState::unknown) << "nobody reports it";
}

TEST(AxisState, an_axis_that_is_excluded_and_not_isolated_is_left_out)
{
    auto voted = test::voted(5);
    voted.excluded_from.exclude(0b1000, 4);
    EXPECT_EQ(state_in_system(tick_of(voted, test::verdict(5, VerdictState::provisional)), 3, 3), AxisState::left_out);
}

TEST(AxisState, all_axes_are_saturated_when_a_detector_says_so_of_the_cluster)
{
    const auto tick = tick_of(test::voted(5), test::verdict(5, VerdictState::saturated));
    for (std::size_t axis = 0; axis < 4; ++axis) EXPECT_EQ(state_in_system(tick, 3, axis), AxisState::saturated);
}

TEST(AxisState, an_isolated_axis_stays_isolated_while_the_cluster_is_saturated)
{
    const auto tick = tick_of(test::voted(5, 0b0001), test::verdict(5, VerdictState::saturated, 0b0001));
    EXPECT_EQ(state_in_system(tick, 3, 0), AxisState::isolated);
}

TEST(AxisState, a_suspicion_of_one_frame_is_seen_in_the_lane_during_its_tick)
{
    Collector collector{test::demo()};
    auto suspicious = test::verdict(5, VerdictState::suspect);
    suspicious.suspect_mask = 0b0010;
    collector.on_verdict(suspicious, 1);
    collector.on_verdict(test::verdict(6), 1);
    EXPECT_EQ(state_in_lane(collector.tick(1, 1).lane[0], 1), AxisState::suspect);
    collector.begin();
    collector.on_verdict(test::verdict(7), 1);
    EXPECT_EQ(state_in_lane(collector.tick(1, 1).lane[0], 1), AxisState::healthy);
}
