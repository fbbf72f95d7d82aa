#include "allocation_count.hpp"
#include "scene.hpp"
#include "quorient/messages/meaning.hpp"

#include <gtest/gtest.h>
#include <limits>

using namespace quorient;
using namespace quorient::voting;
using namespace quorient::voting::test;

namespace {

auto all_but(std::size_t absent)
{
    return [absent](std::size_t lane, AttitudeState&) { return lane != absent; };
}

auto only(std::size_t present)
{
    return [present](std::size_t lane, AttitudeState&) { return lane == present; };
}

void expect_every_frame_once(const Scene& scene, std::uint64_t first, std::uint64_t last)
{
    std::uint64_t expected = first;
    for (const VotedAttitude& output : scene.outputs) {
        if (mode_of(output) == AttitudeMode::coasting) continue;
        EXPECT_EQ(output.sequence, expected);
        expected = output.sequence + 1;
    }
    EXPECT_EQ(expected, last + 1);
}

}  // namespace

TEST(Voter, publishes_the_primarys_attitude_and_never_an_average)
{
    Scene scene;
    scene.frames(0, 49, [](std::size_t lane, AttitudeState& sample) {
        sample = moved(sample, 2e-5 * static_cast<double>(lane));
        return true;
    });
    expect_every_frame_once(scene, 0, 49);
    for (const VotedAttitude& output : scene.outputs) {
        EXPECT_EQ(output.attitude, truth(output.sequence));
        EXPECT_EQ(output.primary_lane, 1U);
    }
    EXPECT_NEAR(scene.last().spread_rad, 2e-5, 1e-9) << "of the two lanes heard when it went out";
}

TEST(Voter, publishes_as_soon_as_a_majority_vouches)
{
    Scene scene;
    scene.frames(0, 9);
    const std::size_t before = scene.outputs.size();
    scene.at(Scene::time_of(10), sample_of(0, 10));
    EXPECT_EQ(scene.outputs.size(), before);
    scene.at(Scene::time_of(10) + 3 * ms, sample_of(2, 10));
    ASSERT_EQ(scene.outputs.size(), before + 1);
    EXPECT_EQ(scene.published_ns.back(), Scene::time_of(10) + 3 * ms);
}

TEST(Voter, waits_no_longer_than_its_patience)
{
    Scene scene;
    scene.frames(0, 9);
    const std::size_t before = scene.outputs.size();
    scene.at(Scene::time_of(10), sample_of(0, 10));
    scene.until(Scene::time_of(10) + interval - ms / 2);
    EXPECT_EQ(scene.outputs.size(), before);
    scene.until(Scene::time_of(10) + interval + ms / 2);
    ASSERT_EQ(scene.outputs.size(), before + 1);
    EXPECT_EQ(scene.last().attitude, truth(10));
}

TEST(Voter, of_one_lane_is_a_valid_system)
{
    Scene scene(1);
    scene.frames(0, 49);
    expect_every_frame_once(scene, 0, 49);
    EXPECT_EQ(scene.voter.level(), VoteLevel::single);
    for (std::size_t frame = 0; frame < 50; ++frame) EXPECT_EQ(scene.published_ns[frame], Scene::time_of(frame)) << "without waiting";
    for (const VoterEvent& event : scene.events) EXPECT_LE(event.severity, Severity::warning_low);
}

TEST(Voter, names_the_lanes_that_vouch_though_their_votes_of_this_frame_are_on_the_way)
{
    Scene scene;
    scene.frames(0, 49);
    EXPECT_EQ(scene.last().vouching_mask, 0b111U);
    scene.frames(50, 99, all_but(2));
    EXPECT_EQ(scene.last().vouching_mask, 0b011U);
}

TEST(Voter, keeps_its_primary_while_another_lane_is_quicker)
{
    Scene scene;
    for (std::uint64_t sequence = 0; sequence < 100; ++sequence) {
        scene.at(Scene::time_of(sequence), sample_of(2, sequence));
        scene.at(Scene::time_of(sequence) + ms, sample_of(1, sequence));
        scene.at(Scene::time_of(sequence) + 4 * ms, sample_of(0, sequence));
    }
    EXPECT_EQ(scene.voter.counters().primary_changes, 0U);
    EXPECT_EQ(scene.last().primary_lane, 1U);
}

TEST(Voter, lets_another_lane_speak_for_a_late_primary_and_keeps_it)
{
    Scene scene;
    scene.frames(0, 299, [](std::size_t lane, AttitudeState& sample) { return lane != 0 || (sample.sequence + 5) % 10 > 2; });
    expect_every_frame_once(scene, 0, 299);
    EXPECT_EQ(scene.voter.counters().primary_changes, 0U);
    EXPECT_EQ(scene.last().primary_lane, 1U);
    EXPECT_FALSE(scene.excluded(0));
}

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

TEST(Voter, never_publishes_what_is_not_an_attitude)
{
    Scene scene;
    scene.frames(0, 49);
    scene.frames(50, 99, [](std::size_t lane, AttitudeState& sample) {
        if (lane != 0) return true;
        if (sample.sequence % 3 == 0) sample.attitude[2] = std::numeric_limits<double>::quiet_NaN();
        if (sample.sequence % 3 == 1) sample.attitude = {0, 0, 0, 0};
        if (sample.sequence % 3 == 2) sample.angle_sigma_rad = std::numeric_limits<double>::infinity();
        return true;
    });
    for (const VotedAttitude& output : scene.outputs) EXPECT_EQ(output.attitude, truth(output.sequence));
    EXPECT_EQ(scene.why(0), LaneExclusion::invalid);
    EXPECT_EQ(scene.voter.counters().rejected, 50U);
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

TEST(Voter, says_lost_while_its_lanes_are_lost)
{
    Scene scene;
    scene.frames(0, 49, [](std::size_t, AttitudeState& sample) {
        sample.mode = octet(AttitudeMode::lost);
        return true;
    });
    EXPECT_EQ(scene.voter.level(), VoteLevel::lost);
    EXPECT_EQ(scene.last().sequence, 49U);
}

TEST(Voter, does_not_let_seeded_lanes_outvote_one_that_knows_better)
{
    for (const bool nobody_unseeded : {false, true}) {
        Scene scene;
        scene.frames(0, 99, [&](std::size_t lane, AttitudeState& sample) {
            sample.seeded = lane != 0 || nobody_unseeded ? 1 : 0;
            if (lane != 0 && sample.sequence >= 50) sample = moved(sample, 0.01);
            return true;
        });
        EXPECT_EQ(scene.last().primary_lane == 1, !nobody_unseeded);
        EXPECT_EQ(scene.excluded(0), nobody_unseeded);
    }
}

TEST(Voter, is_full_again_with_seeded_lanes_that_agree)
{
    Scene scene;
    scene.frames(0, 99, [](std::size_t lane, AttitudeState& sample) {
        sample.seeded = lane != 0 ? 1 : 0;
        return true;
    });
    EXPECT_EQ(scene.voter.level(), VoteLevel::full);
}

TEST(Voter, says_degraded_when_no_redundancy_is_left)
{
    for (const std::uint8_t remaining : {std::uint8_t{0}, std::uint8_t{1}}) {
        Scene scene;
        for (std::uint64_t sequence = 0; sequence < 50; ++sequence) {
            FaultVerdict verdict = verdict_of(0, sequence);
            verdict.detectable_remaining = remaining;
            scene.at(Scene::time_of(sequence) - ms, verdict);
            scene.frames(sequence, sequence);
        }
        EXPECT_EQ(scene.voter.level(), remaining == 0 ? VoteLevel::degraded : VoteLevel::full);
    }
}

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

TEST(Voter, warns_of_a_primary_that_changes_too_often)
{
    const auto worst = [](std::uint64_t period) {
        Scene scene;
        scene.frames(0, 999, [&](std::size_t lane, AttitudeState& sample) {
            if (sample.sequence % period == 0 && lane == (sample.sequence / period) % 3) sample = moved(sample, 1e-2);
            return true;
        });
        Severity severity = Severity::unknown;
        for (const VoterEvent& event : scene.events) {
            if (event.code == EventCode::primary_changed) severity = std::max(severity, event.severity);
        }
        return severity;
    };
    EXPECT_EQ(worst(20), Severity::warning_high);
    EXPECT_EQ(worst(300), Severity::warning_low);
}

TEST(Voter, tells_in_plain_words_what_happened)
{
    Scene scene;
    scene.frames(0, 49);
    scene.frames(50, 99, all_but(0));
    std::string told;
    for (const VoterEvent& event : scene.events) told += std::string(event.text.data()) + "\n";
    EXPECT_NE(told.find("primary lane a -> b: it is silent; the attitude moved by 0 deg"), std::string::npos) << told;
    EXPECT_NE(told.find("lane a does not count: it is silent"), std::string::npos) << told;
    EXPECT_NE(told.find("level FULL -> DEGRADED: 2 of 3 lanes stand behind the output"), std::string::npos) << told;
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

TEST(Voter, allocates_nothing_after_its_construction)
{
    Voter voter(settings_of(3));
    std::int64_t now = 0;
    VotedAttitude output;
    VoterEvent event;
    voter.poll(now);
    const std::size_t before = quorient::test::allocation_count();
    for (std::uint64_t sequence = 0; sequence < 1000; ++sequence) {
        now = Scene::time_of(sequence);
        voter.poll(now);
        for (std::size_t lane = 0; lane < 3; ++lane) {
            if (lane == sequence / 100 % 4) continue;
            voter.on_verdict(verdict_of(lane, sequence, sequence % 97 < 3 ? VerdictState::suspect : VerdictState::healthy, 2), now);
            voter.on_attitude(sample_of(lane, sequence), now);
        }
        while (voter.next_output(output)) continue;
        while (voter.next_event(event)) continue;
    }
    EXPECT_EQ(quorient::test::allocation_count(), before);
    EXPECT_GT(voter.counters().published, 990U);
}

TEST(VoterSettings, are_refused_with_the_reason)
{
    const auto problem = [](auto change) {
        VoterSettings settings = settings_of(3, {1, 2});
        change(settings);
        const auto checked = check(settings);
        return checked ? std::string() : checked.error();
    };
    EXPECT_EQ(problem([](VoterSettings&) {}), "");
    EXPECT_NE(problem([](VoterSettings& s) { s.lanes.clear(); }).find("1 to 8 lanes"), std::string::npos);
    EXPECT_NE(problem([](VoterSettings& s) { s.lanes[1].lane = 1; }).find("same id"), std::string::npos);
    EXPECT_NE(problem([](VoterSettings& s) { s.lanes[1].detector = 101; }).find("same detector"), std::string::npos);
    EXPECT_NE(problem([](VoterSettings& s) { s.voter = 3; }).find("not in the list"), std::string::npos);
    EXPECT_NE(problem([](VoterSettings& s) { s.voters = {1, 1}; }).find("two voters"), std::string::npos);
    EXPECT_NE(problem([](VoterSettings& s) { s.interval_s = 0; }).find("interval_s must be above 0"), std::string::npos);
    EXPECT_NE(problem([](VoterSettings& s) { s.agreement_sigmas = -1; }).find("agreement_sigmas must be 0 or more"), std::string::npos);
    EXPECT_NE(problem([](VoterSettings& s) { s.level_window = 33; }).find("level_window"), std::string::npos);
    EXPECT_NE(problem([](VoterSettings& s) { s.disagreement_frames = 0; }).find("disagreement_frames"), std::string::npos);
}
