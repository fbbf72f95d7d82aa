#include "quorient/messages/meaning.hpp"

#include <gtest/gtest.h>

namespace quorient {
namespace {

TEST(Meaning, of_a_code_from_another_contract_is_unknown)
{
    FaultVerdict verdict;
    for (unsigned octet_value = 0; octet_value < 256; ++octet_value) {
        verdict.state = static_cast<std::uint8_t>(octet_value);
        const bool known = octet_value <= octet(VerdictState::saturated);
        EXPECT_EQ(state_of(verdict), known ? static_cast<VerdictState>(octet_value) : VerdictState::unknown) << octet_value;
    }
    AttitudeState attitude;
    attitude.mode = 200;
    EXPECT_EQ(mode_of(attitude), AttitudeMode::unknown);
}

TEST(Meaning, vouched_are_exactly_the_levels_behind_which_a_majority_stands)
{
    VotedAttitude voted;
    for (const auto level : {VoteLevel::full, VoteLevel::degraded}) {
        voted.level = octet(level);
        EXPECT_TRUE(is_vouched(voted));
    }
    for (const auto level : {VoteLevel::unknown, VoteLevel::single, VoteLevel::coasting, VoteLevel::lost}) {
        voted.level = octet(level);
        EXPECT_FALSE(is_vouched(voted));
    }
}

TEST(Meaning, provisional_is_what_is_left_out_and_not_isolated)
{
    FaultVerdict verdict;
    verdict.excluded_from.exclude(0b0110, 7);
    verdict.isolated_mask = 0b0010;
    EXPECT_EQ(provisional_mask(verdict), 0b0100U);
}

TEST(Meaning, saturation_blames_nobody)
{
    FaultVerdict verdict;
    verdict.state = octet(VerdictState::saturated);
    EXPECT_FALSE(sees_fault(verdict));
    verdict.state = octet(VerdictState::provisional);
    EXPECT_TRUE(sees_fault(verdict));
}

}  // namespace
}  // namespace quorient
