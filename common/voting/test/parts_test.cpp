#include "scene.hpp"

#include "bounded_queue.hpp"
#include "continuity.hpp"
#include "levels.hpp"
#include "newcomers.hpp"
#include "other_voters.hpp"
#include "timeline.hpp"

#include <gtest/gtest.h>

using namespace quorient;
using namespace quorient::voting;
using namespace quorient::voting::test;

TEST(BoundedQueue, gives_back_in_order_and_drops_the_oldest)
{
    BoundedQueue<int, 3> queue;
    for (int entry = 1; entry <= 5; ++entry) queue.push() = entry;
    int entry = 0;
    EXPECT_EQ(queue.dropped(), 2U);
    for (const int expected : {3, 4, 5}) {
        ASSERT_TRUE(queue.pop(entry));
        EXPECT_EQ(entry, expected);
    }
    EXPECT_FALSE(queue.pop(entry));
}

TEST(Levels, are_full_when_all_vouch_and_single_when_one_does)
{
    Levels levels(3, 10);
    for (int frame = 0; frame < 10; ++frame) levels.publish(0b111);
    EXPECT_EQ(levels.level(0, true), VoteLevel::full);
    EXPECT_EQ(levels.level(0, false), VoteLevel::degraded) << "no redundancy left";
    EXPECT_EQ(levels.level(0b010, true), VoteLevel::degraded) << "an excluded lane does not count";
    for (int frame = 0; frame < 10; ++frame) levels.publish(0b001);
    EXPECT_EQ(levels.level(0, true), VoteLevel::single);
}

TEST(Levels, do_not_flap_with_one_missing_vote_in_ten)
{
    Levels levels(3, 10);
    for (int frame = 0; frame < 100; ++frame) {
        levels.publish(frame % 10 == 5 ? 0b011 : 0b111);
        if (frame < 3) continue;
        EXPECT_EQ(levels.level(0, true), VoteLevel::full) << "frame " << frame;
    }
}

TEST(Levels, count_votes_that_come_after_the_output)
{
    Levels levels(3, 10);
    for (int frame = 0; frame < 10; ++frame) {
        levels.publish(0b011);
        levels.late_vote(2, 0);
    }
    levels.publish(0b011);
    EXPECT_EQ(levels.level(0, true), VoteLevel::full);
    for (int frame = 0; frame < 10; ++frame) levels.publish(0b011);
    EXPECT_EQ(levels.level(0, true), VoteLevel::degraded) << "the same without late votes";
}

TEST(Timeline, grants_a_frame_no_patience_before_it_can_be_expected)
{
    Timeline timeline(interval);
    timeline.start({1, 0}, 0);
    timeline.open({1, 0}, 0);
    timeline.publish(0, true, 0);
    timeline.open({1, 4}, 1 * ms);
    EXPECT_EQ(timeline.due_ns(4), 4 * interval);
    timeline.open({1, 1}, interval + 2 * ms);
    EXPECT_EQ(timeline.due_ns(1), interval + 2 * ms) << "a frame that comes late is due when it comes";
}

TEST(Timeline, believes_a_jump_only_as_far_as_time_allows)
{
    Timeline timeline(interval);
    timeline.start({1, 0}, 0);
    timeline.open({1, 0}, 0);
    timeline.publish(0, true, 0);
    EXPECT_EQ(timeline.classify({1, 400}, 10 * ms), Timeline::Arrival::ahead);
    EXPECT_EQ(timeline.classify({1, 400}, 2000 * ms), Timeline::Arrival::fresh);
    EXPECT_EQ(timeline.classify({1, 0}, 10 * ms), Timeline::Arrival::late);
    EXPECT_EQ(timeline.classify({0, 5}, 10 * ms), Timeline::Arrival::old);
    EXPECT_EQ(timeline.classify({2, 0}, 10 * ms), Timeline::Arrival::ahead);
}

TEST(Newcomers, need_a_majority_or_the_silence_of_the_others)
{
    Newcomers newcomers(3, 2, 100 * ms);
    newcomers.expected(1, true, 0);
    newcomers.hold(0, sample_of(0, 0, 2000), 1 * ms);
    EXPECT_FALSE(newcomers.accepted(2 * ms));
    newcomers.expected(1, true, 90 * ms);
    EXPECT_FALSE(newcomers.accepted(150 * ms)) << "another lane is still on the old timeline";
    EXPECT_TRUE(newcomers.accepted(191 * ms)) << "no lane is on the old timeline any more";

    Newcomers majority(3, 2, 100 * ms);
    majority.hold(0, sample_of(0, 1, 2000), 1 * ms);
    majority.hold(2, sample_of(2, 0, 2000), 2 * ms);
    ASSERT_TRUE(majority.accepted(2 * ms));
    EXPECT_EQ(*majority.accepted(2 * ms), (Identity{2000, 0}));
}

TEST(Continuity, tells_the_rotation_between_two_lanes_from_the_frame_that_both_know)
{
    VotedAttitude output;
    output.epoch = first_epoch;
    output.sequence = 9;
    output.attitude = truth(9);
    output.reset_counter = 4;
    Continuity continuity;
    continuity.follow(output);

    const AttitudeState before = moved(sample_of(1, 9), 0.02);
    const auto reset = continuity.next(moved(sample_of(1, 10), 0.02), &before);
    EXPECT_TRUE(reset.moved);
    EXPECT_EQ(reset.counter, 5U);
    EXPECT_NEAR(angle_between(product(reset.rotation, truth(10)), moved(sample_of(1, 10), 0.02).attitude), 0, 1e-12);

    const AttitudeState same = sample_of(1, 9);
    EXPECT_FALSE(continuity.next(sample_of(1, 10), &same).moved) << "a lane at the same place moves nothing";
}

TEST(Continuity, passes_on_what_the_lane_itself_announces)
{
    VotedAttitude output;
    output.epoch = first_epoch;
    output.sequence = 9;
    output.attitude = moved(sample_of(0, 9), 0.03).attitude;
    Continuity continuity;
    continuity.follow(output);

    const AttitudeState before = moved(sample_of(0, 9), 0.03);
    AttitudeState corrected = sample_of(0, 10);
    corrected.reset_counter = 1;
    corrected.reset_rotation = turn(-0.03);
    const auto reset = continuity.next(corrected, &before);
    EXPECT_TRUE(reset.moved);
    EXPECT_NEAR(angle_between(reset.rotation, turn(-0.03)), 0, 1e-12);
}

TEST(Continuity, estimates_the_rotation_where_no_frame_is_known_to_both)
{
    VotedAttitude output;
    output.epoch = first_epoch;
    output.sequence = 9;
    output.sample_time_ns = Scene::time_of(9);
    output.attitude = truth(9);
    output.rate_rad_s = {0.7, 0, 0};
    Continuity continuity;
    continuity.follow(output);
    const auto reset = continuity.next(moved(sample_of(2, 12), 0.02), nullptr);
    EXPECT_NEAR(angle_between(reset.rotation, turn(0.02)), 0, 1e-9);
}

/// A voter that is behind, or repeats an old frame, numbers it beside what the other gave it.
TEST(OtherVoters, number_an_older_frame_as_the_other_did)
{
    const VoterSettings settings = settings_of(3, {1, 2}, 1);
    OtherVoters others(settings, Durations(settings));
    for (std::uint64_t sequence = 300; sequence < 400; ++sequence) ASSERT_TRUE(others.on_output(output_by(2, sequence, sequence + 7), 0));
    EXPECT_EQ(others.next_output_sequence({first_epoch, 400}, 0), 407U);
    EXPECT_EQ(others.next_output_sequence({first_epoch, 399}, 0), 406U);
    EXPECT_EQ(others.next_output_sequence({first_epoch, 390}, 0), 397U);
    EXPECT_EQ(others.next_output_sequence({first_epoch, 305}, 0), 312U) << "no longer remembered: counted back";
}

/// What the other has published since is on its way: a smaller number would be a step back for readers.
TEST(OtherVoters, number_a_frame_as_if_the_other_had_published_all_up_to_it)
{
    const VoterSettings settings = settings_of(3, {1, 2}, 1);
    OtherVoters others(settings, Durations(settings));
    ASSERT_TRUE(others.on_output(output_by(2, 100, 110), 0));
    EXPECT_EQ(others.next_output_sequence({first_epoch, 104}, 50), 114U);
    EXPECT_EQ(others.next_output_sequence({first_epoch, 104}, 120), 121U);
    EXPECT_EQ(others.next_output_sequence({first_epoch + 1, 0}, 50), 111U);
}
