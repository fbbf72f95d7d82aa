#include "allocation_count.hpp"
#include "lane_choice.hpp"
#include "quorient/messages/meaning.hpp"

#include <gtest/gtest.h>
#include <limits>

using namespace quorient;
using namespace quorient::voting;
using namespace quorient::voting::test;

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
    EXPECT_NEAR(scene.last().spread_rad, 2e-5, 1e-9) << "of the two lanes received when it went out";
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
    std::string texts;
    for (const VoterEvent& event : scene.events) texts += std::string(event.text.data()) + "\n";
    EXPECT_NE(texts.find("primary lane a -> b: it is silent; the attitude moved by 0 deg"), std::string::npos) << texts;
    EXPECT_NE(texts.find("lane a does not count: it is silent"), std::string::npos) << texts;
    EXPECT_NE(texts.find("level FULL -> DEGRADED: 2 of 3 lanes stand behind the output"), std::string::npos) << texts;
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
