#include "quorient/evaluation/fault_spells.hpp"
#include "quorient/messages/codes.hpp"
#include "quorient/messages/meaning.hpp"

#include <gtest/gtest.h>

namespace quorient::evaluation {

namespace {

constexpr AxisMask faulty = 0b0100;

FaultVerdict verdict_of(VerdictState state, AxisMask isolated = 0)
{
    FaultVerdict verdict;
    verdict.state = octet(state);
    verdict.isolated_mask = isolated;
    return verdict;
}

TEST(Reaction, is_timed_by_the_first_verdicts_that_see_and_isolate_the_fault)
{
    Reaction reaction;
    reaction.update(verdict_of(VerdictState::healthy), faulty, 1);
    reaction.update(verdict_of(VerdictState::suspect), faulty, 2);
    reaction.update(verdict_of(VerdictState::isolated, 0b0110), faulty, 3);
    reaction.update(verdict_of(VerdictState::isolated, 0b0100), faulty, 4);
    EXPECT_EQ(reaction.detected_s, 2.0);
    EXPECT_EQ(reaction.isolated_s, 3.0);
    EXPECT_EQ(reaction.isolated, 0b0110U);
}

TEST(Reaction, to_a_fault_is_not_the_isolation_of_another_axis)
{
    Reaction reaction;
    reaction.update(verdict_of(VerdictState::isolated, 0b0010), faulty, 1);
    EXPECT_EQ(reaction.detected_s, 1.0);
    EXPECT_FALSE(reaction.isolated_s);
}

TEST(Reaction, is_none_while_all_is_healthy)
{
    Reaction reaction;
    reaction.update(verdict_of(VerdictState::warming_up), faulty, 1);
    reaction.update(verdict_of(VerdictState::healthy), faulty, 2);
    EXPECT_FALSE(reaction.detected_s);
    EXPECT_FALSE(reaction.isolated_s);
}

}  // namespace

}  // namespace quorient::evaluation
