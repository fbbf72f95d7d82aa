#include "quorient/messages/stream_place.hpp"

#include <gtest/gtest.h>

namespace quorient {
namespace {

TEST(StreamPlace, counts_the_frames_between_two_that_came)
{
    const auto place = StreamPlace::behind({3, 10});
    EXPECT_EQ(place.missing_before({3, 11}), 0u);
    EXPECT_EQ(place.missing_before({3, 12}), 1u);
    EXPECT_EQ(place.missing_before({3, 111}), 100u);
}

TEST(StreamPlace, counts_from_0_in_a_new_epoch)
{
    const auto place = StreamPlace::behind({3, 10});
    EXPECT_EQ(place.missing_before({4, 0}), 0u);
    EXPECT_EQ(place.missing_before({4, 20}), 20u);
    EXPECT_EQ(StreamPlace::at_begin_of(4).missing_before({4, 20}), 20u);
}

TEST(StreamPlace, is_followed_by_the_very_next_frame_alone)
{
    const auto place = StreamPlace::behind({3, 10});
    EXPECT_TRUE(place.follows({3, 11}));
    EXPECT_FALSE(place.follows({3, 10}));
    EXPECT_FALSE(place.follows({3, 12}));
    EXPECT_FALSE(place.follows({4, 11}));
}

}  // namespace
}  // namespace quorient
