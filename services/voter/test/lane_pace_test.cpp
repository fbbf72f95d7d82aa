// When a voter compares only the frames that overloaded lanes keep.

#include "lane_pace.hpp"

#include <gtest/gtest.h>
#include <array>

namespace quorient::voter {

namespace {

constexpr std::int64_t interval_ns = 5'000'000;

class Lanes : public testing::Test {
protected:
    /// Two hundred frames. @param steps  of the sequence numbers, per lane; 0 = the lane is silent
    void give_out(std::array<std::uint64_t, 3> steps)
    {
        for (const std::uint64_t end = next_ + 200; next_ < end; ++next_) {
            now_ns_ += interval_ns;
            for (std::size_t lane = 0; lane < steps.size(); ++lane)
                if (steps[lane] != 0 && next_ % steps[lane] == 0) pace_.see(lane, {1, next_}, now_ns_);
        }
    }

    bool many_shed() const { return pace_.many_shed(now_ns_); }

    LanePace pace_{3};
    std::uint64_t next_ = 0;
    std::int64_t now_ns_ = 0;
};

TEST_F(Lanes, that_give_out_all_frames_are_compared_in_all)
{
    give_out({1, 1, 1});
    EXPECT_FALSE(many_shed());
    EXPECT_FALSE(pace_.sheds(0));
}

TEST_F(Lanes, of_which_one_of_three_is_overloaded_are_compared_in_all_frames_of_the_others)
{
    give_out({1, 4, 1});
    EXPECT_FALSE(many_shed());
    EXPECT_TRUE(pace_.sheds(1));
}

TEST_F(Lanes, of_which_two_are_overloaded_are_compared_in_kept_frames)
{
    give_out({4, 4, 1});
    EXPECT_TRUE(many_shed());
    give_out({1, 1, 1});
    EXPECT_FALSE(many_shed()) << "once they keep up again";
}

TEST_F(Lanes, of_which_one_of_two_that_speak_is_overloaded_are_compared_in_kept_frames)
{
    give_out({1, 1, 1});
    give_out({4, 1, 0});
    EXPECT_TRUE(many_shed()) << "the votes of both are needed";
}

}  // namespace

}  // namespace quorient::voter
