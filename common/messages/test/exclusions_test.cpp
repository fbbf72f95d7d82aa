#include "quorient/messages/attitude_state.hpp"
#include "quorient/messages/exclusions.hpp"
#include "quorient/messages/fault_verdict.hpp"
#include "quorient/messages/voted_attitude.hpp"

#include <gtest/gtest.h>

namespace quorient {
namespace {

Exclusions two_axes()
{
    Exclusions exclusions;
    exclusions[1] = 40;
    exclusions[7] = 0;
    return exclusions;
}

TEST(Exclusions, begin_with_none_in_every_message)
{
    EXPECT_EQ(FaultVerdict{}.excluded_from.mask(), 0U);
    EXPECT_EQ(AttitudeState{}.excluded_from.mask(), 0U);
    EXPECT_EQ(VotedAttitude{}.excluded_from.mask(), 0U);
    for (const std::uint64_t sequence : Exclusions{}) EXPECT_EQ(sequence, never);
}

TEST(Exclusions, name_the_axes_that_are_excluded_and_since_when)
{
    EXPECT_EQ(two_axes().mask(), 0b1000'0010U);
    EXPECT_EQ(two_axes().mask_at(39), 0b1000'0000U);
    EXPECT_EQ(two_axes().mask_at(40), 0b1000'0010U);
    EXPECT_EQ(two_axes().earliest(0b10), 40U);
    EXPECT_EQ(two_axes().earliest(~0U), 0U);
    EXPECT_EQ(two_axes().earliest(0b100), never);
}

TEST(Exclusions, count_from_sequence_0_in_a_new_epoch)
{
    const Exclusions renewed = two_axes().in_new_epoch();
    EXPECT_EQ(renewed.mask(), two_axes().mask());
    EXPECT_EQ(renewed[1], 0U);
    EXPECT_EQ(renewed[7], 0U);
    EXPECT_EQ(renewed[2], never);
}

TEST(Exclusions, of_some_axes_leave_the_others_trusted)
{
    EXPECT_EQ(two_axes().of(0b111).mask(), 0b10U);
    EXPECT_EQ(two_axes().of(0b111)[1], 40U);
}

TEST(Exclusions, can_be_taken_back)
{
    Exclusions exclusions = two_axes();
    exclusions.exclude(0b1, 5);
    exclusions.readmit(0b10);
    EXPECT_EQ(exclusions.mask(), 0b1000'0001U);
    EXPECT_EQ(exclusions[0], 5U);
}

}  // namespace
}  // namespace quorient
