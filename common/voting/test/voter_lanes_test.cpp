// Which lanes count: death and silence, exclusion and return.
#include "lane_choice.hpp"
#include "quorient/messages/meaning.hpp"

#include <gtest/gtest.h>

using namespace quorient;
using namespace quorient::voting;
using namespace quorient::voting::test;

TEST(Voter, loses_no_frame_when_the_primary_dies)
{
    Scene scene;
    scene.frames(0, 49);
    scene.frames(50, 149, all_but(0));
    expect_every_frame_once(scene, 0, 149);
    EXPECT_EQ(scene.voter.counters().primary_changes, 1U);
    EXPECT_EQ(scene.why(0), LaneExclusion::silent);
    EXPECT_EQ(scene.voter.level(), VoteLevel::degraded);
    for (std::size_t frame = 1; frame < scene.published_ns.size(); ++frame) {
        EXPECT_LE(scene.published_ns[frame] - scene.published_ns[frame - 1], 2 * interval + ms) << "frame " << frame;
    }
}

TEST(Voter, calls_a_lane_silent_after_five_intervals_and_not_before)
{
    Scene scene;
    scene.frames(0, 49);
    scene.frames(50, 54, all_but(1));
    EXPECT_FALSE(scene.excluded(1));
    scene.frames(55, 57, all_but(1));
    EXPECT_EQ(scene.why(1), LaneExclusion::silent);
}

TEST(Voter, blames_no_lane_when_all_are_silent)
{
    Scene scene;
    scene.frames(0, 49);
    scene.until(Scene::time_of(249));
    scene.frames(250, 260);
    EXPECT_EQ(scene.last().excluded_mask, 0U);
    EXPECT_EQ(scene.last().sequence, 260U);
}

TEST(Voter, lets_a_lane_return_after_200_agreeing_frames)
{
    Scene scene;
    scene.frames(0, 49);
    scene.frames(50, 99, all_but(1));
    scene.frames(100, 290);
    EXPECT_TRUE(scene.excluded(1));
    scene.frames(291, 325);
    EXPECT_FALSE(scene.excluded(1));
    EXPECT_EQ(scene.voter.level(), VoteLevel::full);
}

TEST(Voter, starts_the_return_over_when_the_lane_disagrees_again)
{
    Scene scene;
    scene.frames(0, 49);
    scene.frames(50, 99, all_but(1));
    scene.frames(100, 310, [](std::size_t lane, AttitudeState& sample) {
        if (lane == 1 && sample.sequence == 200) sample = moved(sample, 0.01);
        return true;
    });
    EXPECT_TRUE(scene.excluded(1));
}

TEST(Voter, excludes_a_lane_that_a_majority_contradicts)
{
    Scene scene;
    scene.frames(0, 49);
    scene.frames(50, 69, [](std::size_t lane, AttitudeState& sample) {
        if (lane == 2) sample = moved(sample, 1e-3);
        return true;
    });
    EXPECT_EQ(scene.why(2), LaneExclusion::disagrees);
    EXPECT_EQ(scene.last().attitude, truth(69));
    EXPECT_EQ(scene.count(EventCode::lane_excluded), 1U);
}

TEST(Voter, excludes_nobody_for_less_than_the_agreement)
{
    Scene scene;
    scene.frames(0, 99, [](std::size_t lane, AttitudeState& sample) {
        if (lane == 2) sample = moved(sample, 1.5e-4);
        return true;
    });
    EXPECT_EQ(scene.last().excluded_mask, 0U);
    EXPECT_EQ(scene.voter.level(), VoteLevel::full);
}

TEST(Voter, leaves_a_contradicted_primary_within_the_same_frame)
{
    Scene scene;
    scene.frames(0, 49);
    scene.frames(50, 69, [](std::size_t lane, AttitudeState& sample) {
        if (lane == 0) sample = moved(sample, 0.5);
        return true;
    });
    for (const VotedAttitude& output : scene.outputs) EXPECT_EQ(output.attitude, truth(output.sequence));
    expect_every_frame_once(scene, 0, 69);
    EXPECT_EQ(scene.why(0), LaneExclusion::disagrees);
    EXPECT_EQ(scene.voter.counters().primary_changes, 1U);
}

TEST(Voter, of_two_lanes_cannot_tell_who_is_right_and_says_so)
{
    Scene scene(2);
    scene.frames(0, 49);
    EXPECT_EQ(scene.voter.level(), VoteLevel::full);
    scene.frames(50, 79, [](std::size_t lane, AttitudeState& sample) {
        if (lane == 1) sample = moved(sample, 0.5);
        return true;
    });
    EXPECT_EQ(scene.voter.level(), VoteLevel::single);
    EXPECT_EQ(scene.last().excluded_mask, 0U);
    EXPECT_EQ(scene.last().primary_lane, 1U) << "it stays where it is";
}

TEST(Voter, counts_no_lane_that_is_initialising_or_fuses_nothing)
{
    for (const bool initialising : {true, false}) {
        Scene scene;
        scene.frames(0, 99, [&](std::size_t lane, AttitudeState& sample) {
            if (lane != 2) return lane == 0;
            if (initialising) sample.mode = octet(AttitudeMode::initialising);
            else sample.used_mask = 0;
            return true;
        });
        EXPECT_EQ(scene.voter.level(), VoteLevel::single) << "a lane that fuses nothing agrees with everybody and says nothing";
        EXPECT_EQ(scene.why(2), LaneExclusion::initialising);
        EXPECT_EQ(scene.last().vouching_mask, 1U);
    }
}

TEST(Voter, never_moves_to_a_lane_that_is_initialising)
{
    Scene scene;
    scene.frames(0, 49);
    scene.frames(50, 99, [](std::size_t lane, AttitudeState& sample) {
        if (lane == 1) sample.mode = octet(AttitudeMode::initialising);
        return lane != 0;
    });
    EXPECT_EQ(scene.last().primary_lane, 3U);
}

TEST(Voter, prefers_a_lane_whose_detector_is_not_blind)
{
    Scene scene;
    scene.frames(0, 49);
    scene.frames(50, 69, [](std::size_t lane, AttitudeState& sample) {
        if (lane == 0) sample.mode = octet(AttitudeMode::untrusted);
        return true;
    });
    EXPECT_EQ(scene.last().primary_lane, 2U);
    EXPECT_EQ(scene.why(0), LaneExclusion::untrusted);
    scene.frames(70, 99, [](std::size_t, AttitudeState& sample) {
        sample.mode = octet(AttitudeMode::untrusted);
        return true;
    });
    EXPECT_EQ(scene.last().sequence, 99U) << "with everybody blind the output goes on and says so";
    EXPECT_EQ(scene.last().mode, octet(AttitudeMode::untrusted));
}

TEST(Voter, returns_at_once_to_the_only_lane_left)
{
    Scene scene;
    scene.frames(0, 49);
    scene.frames(50, 99, all_but(1));
    scene.frames(100, 199, only(1));
    EXPECT_EQ(scene.last().sequence, 199U);
    EXPECT_EQ(scene.last().primary_lane, 2U);
    EXPECT_FALSE(scene.excluded(1));
}

TEST(Voter, never_speaks_of_its_primary_as_excluded)
{
    Scene scene;
    scene.frames(0, 49);
    for (std::uint64_t dead = 0; dead < 6; ++dead) {
        scene.frames(50 + 50 * dead, 99 + 50 * dead, all_but(dead % 3));
    }
    for (const VotedAttitude& output : scene.outputs) EXPECT_EQ(output.excluded_mask >> (output.primary_lane - 1) & 1U, 0U);
}

TEST(Voter, survives_a_short_delay_of_its_own_without_blaming_a_lane)
{
    Scene scene;
    scene.frames(0, 49);
    scene.at(Scene::time_of(50), sample_of(0, 50));
    scene.stopped_until(Scene::time_of(50) + 40 * ms);  // lanes b and c wait in their queues
    for (std::uint64_t sequence = 50; sequence < 58; ++sequence) {
        for (std::size_t lane = 0; lane < 3; ++lane) scene.at(scene.now, sample_of(lane, sequence));
    }
    scene.frames(58, 80);
    expect_every_frame_once(scene, 0, 80);
    EXPECT_EQ(scene.voter.counters().primary_changes, 0U);
    EXPECT_EQ(scene.last().excluded_mask, 0U);
}
