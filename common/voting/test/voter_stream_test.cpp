// The stream of outputs: coasting, resets, epochs, what is dropped.
#include "lane_choice.hpp"
#include "quorient/messages/meaning.hpp"

#include <gtest/gtest.h>

using namespace quorient;
using namespace quorient::voting;
using namespace quorient::voting::test;

TEST(Voter, coasts_at_20_hz_with_growing_doubt_and_then_is_lost)
{
    Scene scene;
    scene.frames(0, 49);
    const std::size_t before = scene.outputs.size();
    scene.until(Scene::time_of(49) + 2000 * ms);
    const std::size_t coasted = scene.outputs.size() - before;
    EXPECT_NEAR(static_cast<double>(coasted), 20 * (2.0 - 0.025), 1);
    for (std::size_t output = before; output < scene.outputs.size(); ++output) {
        const VotedAttitude& now = scene.outputs[output];
        const VotedAttitude& previous = scene.outputs[output - 1];
        const bool lost = scene.published_ns[output] >= Scene::time_of(49) + 1025 * ms;
        EXPECT_EQ(now.attitude, truth(49));
        EXPECT_EQ(now.sequence, 49U);
        EXPECT_EQ(now.output_sequence, previous.output_sequence + 1);
        EXPECT_GT(now.angle_sigma_rad, previous.angle_sigma_rad);
        EXPECT_GE(now.angle_sigma_rad, 0.7 * static_cast<double>(scene.published_ns[output] - scene.published_ns[before - 1]) * 1e-9);
        EXPECT_EQ(now.level, static_cast<std::uint8_t>(lost ? VoteLevel::lost : VoteLevel::coasting));
        EXPECT_EQ(now.vouching_mask, 0U);
    }
    EXPECT_EQ(scene.count(EventCode::coasting), 1U);
    EXPECT_EQ(scene.count(EventCode::lost), 1U);
}

TEST(Voter, goes_on_as_soon_as_frames_come_again)
{
    Scene scene;
    scene.frames(0, 49);
    scene.until(Scene::time_of(49) + 3000 * ms);
    scene.frames(649, 660);
    EXPECT_EQ(scene.voter.level(), VoteLevel::full);
    EXPECT_EQ(scene.last().sequence, 660U);
    EXPECT_EQ(scene.voter.counters().gaps, 599U);
}

TEST(Voter, does_not_coast_while_frames_come)
{
    Scene scene;
    scene.frames(0, 399);
    EXPECT_EQ(scene.count(EventCode::coasting), 0U);
    EXPECT_EQ(scene.outputs.size(), 400U);
}

TEST(Voter, announces_a_change_of_primary_that_moves_the_attitude_as_a_reset)
{
    Scene scene;
    const auto shifted = [](std::size_t lane, AttitudeState& sample) {
        if (lane == 1) sample = moved(sample, 8e-5);
        if (lane == 2) sample = moved(sample, 9e-5);
        return sample.sequence < 50 || lane != 0;
    };
    scene.frames(0, 99, shifted);
    EXPECT_EQ(scene.last().primary_lane, 2U);
    EXPECT_EQ(scene.last().reset_counter, 1U);
    EXPECT_NEAR(angle_between(product(scene.last().reset_rotation, truth(99)), scene.last().attitude), 0, 1e-12);
}

TEST(Voter, announces_no_reset_when_nothing_moves)
{
    Scene scene;
    scene.frames(0, 49);
    scene.frames(50, 99, all_but(0));
    EXPECT_EQ(scene.last().primary_lane, 2U);
    EXPECT_EQ(scene.last().reset_counter, 0U);
}

TEST(Voter, passes_on_the_primarys_own_reset)
{
    Scene scene;
    scene.frames(0, 99, [](std::size_t, AttitudeState& sample) {
        if (sample.sequence < 50) sample = moved(sample, 0.02);
        else {
            sample.reset_counter = 1;
            sample.reset_rotation = turn(-0.02);
        }
        return true;
    });
    EXPECT_EQ(scene.last().reset_counter, 1U);
    EXPECT_NEAR(angle_between(scene.last().reset_rotation, turn(-0.02)), 0, 1e-12);
}

TEST(Voter, follows_the_lanes_into_a_new_epoch)
{
    Scene scene;
    scene.frames(0, 49);
    scene.until(Scene::time_of(49) + 500 * ms);
    for (std::uint64_t sequence = 0; sequence < 20; ++sequence) {
        for (std::size_t lane = 0; lane < 3; ++lane) scene.at(Scene::time_of(sequence + 160), sample_of(lane, sequence, 2000));
    }
    EXPECT_EQ(scene.last().epoch, 2000U);
    EXPECT_EQ(scene.last().sequence, 19U);
    EXPECT_EQ(scene.count(EventCode::new_epoch), 2U) << "the first one and the second";
}

TEST(Voter, lets_one_lane_alone_announce_no_epoch)
{
    Scene scene;
    scene.frames(0, 49);
    for (std::uint64_t sequence = 50; sequence < 150; ++sequence) {
        scene.at(Scene::time_of(sequence), sample_of(2, sequence - 50, 2000));
        scene.frames(sequence, sequence, all_but(2));
    }
    EXPECT_EQ(scene.last().epoch, first_epoch);
    EXPECT_EQ(scene.last().sequence, 149U);
    EXPECT_EQ(scene.why(2), LaneExclusion::silent) << "what it says is of no frame we know";
}

TEST(Voter, lets_the_last_lane_alive_announce_an_epoch_after_a_while)
{
    Scene scene;
    scene.frames(0, 49);
    for (std::uint64_t sequence = 0; sequence < 60; ++sequence) scene.at(Scene::time_of(sequence + 150), sample_of(2, sequence, 2000));
    EXPECT_EQ(scene.last().epoch, 2000U);
    EXPECT_EQ(scene.last().primary_lane, 3U);
}

TEST(Voter, is_not_hurried_by_a_lane_that_runs_ahead_of_time)
{
    Scene scene;
    scene.frames(0, 49);
    for (std::uint64_t sequence = 50; sequence < 100; ++sequence) {
        for (std::size_t lane = 1; lane < 3; ++lane)
            scene.at(Scene::time_of(sequence) + static_cast<std::int64_t>(lane) * ms, sample_of(lane, sequence));
        scene.at(Scene::time_of(sequence) + 3 * ms, moved(sample_of(0, sequence + 5), 0.5));
    }
    for (const VotedAttitude& output : scene.outputs) EXPECT_EQ(output.attitude, truth(output.sequence));
    EXPECT_EQ(scene.last().sequence, 99U);
}

TEST(Voter, drops_and_counts_duplicates_and_what_comes_too_late)
{
    Scene scene;
    scene.frames(0, 199);
    const std::size_t before = scene.outputs.size();
    scene.at(scene.now, sample_of(1, 199));
    EXPECT_EQ(scene.voter.counters().duplicates, 1U);
    const auto late = scene.voter.counters().late;
    scene.at(scene.now, sample_of(1, 3));
    EXPECT_EQ(scene.voter.counters().late, late + 1);
    EXPECT_EQ(scene.outputs.size(), before);
}

/// A majority publishes a frame at once; the third lane's sample is always behind it.
TEST(Voter, counts_no_lane_as_late_whose_sample_comes_before_patience_ends)
{
    const auto late_after = [](std::int64_t behind_ns) {
        Scene scene;
        for (std::uint64_t sequence = 0; sequence < 100; ++sequence) {
            for (std::size_t lane = 0; lane < 2; ++lane) scene.at(Scene::time_of(sequence), sample_of(lane, sequence));
            const std::int64_t now = Scene::time_of(sequence) + interval - 1;
            for (const std::uint64_t third : {sequence, sequence - 1}) {
                const std::int64_t time = Scene::time_of(third) + behind_ns;
                if (third <= sequence && time > now - interval && time <= now) scene.at(time, sample_of(2, third));
            }
        }
        EXPECT_EQ(scene.outputs.size(), 100U);
        return scene.voter.counters().late;
    };
    EXPECT_EQ(late_after(4 * ms), 0U);
    EXPECT_GT(late_after(6 * ms), 90U);
}

TEST(Voter, counts_what_is_not_of_its_unit_or_lanes_as_foreign)
{
    Scene scene;
    scene.frames(0, 9);
    AttitudeState stranger = sample_of(5, 10);
    scene.at(scene.now, stranger);
    stranger = sample_of(0, 10);
    stranger.unit = 8;
    scene.at(scene.now, stranger);
    FaultVerdict verdict = verdict_of(9, 10);
    scene.at(scene.now, verdict);
    EXPECT_EQ(scene.voter.counters().foreign, 3U);
}
