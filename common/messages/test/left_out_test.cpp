#include "quorient/messages/left_out.hpp"

#include "quorient/messages/fault_verdict.hpp"

#include <gtest/gtest.h>

namespace quorient {
namespace {

TEST(LeftOut, is_what_is_isolated_or_excluded_in_the_messages_frame)
{
    FaultVerdict verdict;
    verdict.excluded_from.exclude(0b0110, 7);
    verdict.isolated_mask = 0b0010;
    verdict.sequence = 7;
    EXPECT_EQ(left_out_mask(verdict), 0b0110U);
    verdict.sequence = 6;
    EXPECT_EQ(left_out_mask(verdict), 0b0010U) << "the provisional exclusion begins with a later frame";
}

TEST(LeftOut, isolations_of_a_vouched_attitude_are_all_that_others_may_adopt)
{
    VotedAttitude voted;
    voted.excluded_from.exclude(0b0110, 7);
    voted.isolated_mask = 0b0010;
    voted.level = octet(VoteLevel::single);
    EXPECT_FALSE(vouched_exclusions(voted));
    voted.level = octet(VoteLevel::degraded);
    ASSERT_TRUE(vouched_exclusions(voted));
    EXPECT_EQ(vouched_exclusions(voted)->mask(), 0b0010U);
    EXPECT_EQ((*vouched_exclusions(voted))[1], 7U);
}

}  // namespace
}  // namespace quorient
