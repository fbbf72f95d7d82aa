#include "quorient/runtime/signals.hpp"

#include <gtest/gtest.h>
#include <unistd.h>
#include <cstdlib>

namespace quorient::runtime {

TEST(EndsWithinDeathTest, a_process_that_cannot_leave_ends_with_its_exit_code_and_says_why)
{
    EXPECT_EXIT(
        {
            leave_within(1, 7);
            for (;;) ::pause();
        },
        testing::ExitedWithCode(7), "could not be left in time");
}

TEST(EndsWithinDeathTest, a_process_that_leaves_in_time_says_nothing)
{
    EXPECT_EXIT(
        {
            leave_within(1, 7);
            std::_Exit(7);
        },
        testing::ExitedWithCode(7), "^$");
}

}  // namespace quorient::runtime
