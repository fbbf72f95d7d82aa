#include "other_voters.hpp"
#include "owned_stream.hpp"
#include "pair_of_voters.hpp"

#include <gtest/gtest.h>
#include <memory>
#include <vector>

using namespace quorient;
using namespace quorient::voting;
using namespace quorient::voting::test;

namespace {

const VotedAttitude* output_of(const Scene& scene, std::uint64_t sequence)
{
    for (const VotedAttitude& output : scene.outputs) {
        if (output.sequence == sequence) return &output;
    }
    return nullptr;
}

auto lanes_apart = [](std::size_t lane, AttitudeState& sample) {
    sample = moved(sample, 3e-5 * static_cast<double>(lane));
    return true;
};

}  // namespace

TEST(TwoVoters, publish_the_same_in_step)
{
    Pair pair;
    pair.frames(0, 99, lanes_apart);
    for (std::uint64_t sequence = 20; sequence < 100; ++sequence) {
        const VotedAttitude* a = output_of(pair.strong, sequence);
        const VotedAttitude* b = output_of(pair.weak, sequence);
        ASSERT_TRUE(a != nullptr && b != nullptr) << sequence;
        EXPECT_EQ(a->attitude, b->attitude);
        EXPECT_EQ(a->output_sequence, b->output_sequence);
        EXPECT_EQ(a->reset_counter, b->reset_counter);
    }
    EXPECT_TRUE(pair.strong.voter.owns());
    EXPECT_FALSE(pair.weak.voter.owns());
}

TEST(TwoVoters, write_no_frame_both_while_they_have_not_found_each_other)
{
    Pair pair;
    pair.strong_delivered = pair.weak_delivered = 1'000'000;  // discovery takes its time
    pair.frames(0, 199);
    ASSERT_EQ(pair.strong.owned.size(), 180U);
    EXPECT_FALSE(pair.weak.voter.may_own());
    EXPECT_TRUE(pair.weak.owned.empty());

    pair.strong_delivered = pair.strong.outputs.size();
    pair.weak_delivered = pair.weak.outputs.size();
    pair.frames(200, 299);
    EXPECT_TRUE(pair.weak.voter.may_own());
    ASSERT_FALSE(pair.weak.owned.empty()) << "it stands by, for readers that lose the stronger one";
    EXPECT_EQ(pair.weak.owned.back().sequence, 299U);
}

/// The lanes' samples reach the weaker voter so many frames late, the stronger voter's outputs in time, until that one dies.
/// @returns what the weaker one writes to `voted` when readers listen to it: a lease after the other's death
std::vector<std::uint64_t> written_by_the_weaker(std::uint64_t lag)
{
    constexpr std::uint64_t death = 300;
    Scene weak(settings_of(3, {1, 2}, 2));
    std::size_t before = 0;
    for (std::uint64_t sequence = 0; sequence < 400; ++sequence) {
        const std::int64_t time = Scene::time_of(sequence);
        if (sequence < death) weak.at(time, output_by(1, sequence, sequence + 1));
        const std::uint64_t late = sequence < 150 ? 0 : lag;
        if (sequence == death + 10) before = weak.owned.size();
        for (std::size_t lane = 0; lane < 3; ++lane) weak.at(time + ms, sample_of(lane, sequence - late));
    }
    std::vector<std::uint64_t> written;
    for (std::size_t i = before; i < weak.owned.size(); ++i) written.push_back(weak.owned[i].sequence);
    return written;
}

TEST(TwoVoters, the_weaker_one_that_is_behind_writes_nothing_that_is_older_than_what_the_dead_one_wrote)
{
    const auto punctual = written_by_the_weaker(2);
    ASSERT_FALSE(punctual.empty());
    EXPECT_EQ(punctual.front(), 308U);
    EXPECT_EQ(punctual.back(), 397U);
    const auto behind = written_by_the_weaker(15);
    ASSERT_FALSE(behind.empty());
    EXPECT_EQ(behind.front(), 300U) << "the first frame that the stronger one did not publish";
    EXPECT_EQ(behind.back(), 384U);
}

TEST(TwoVoters, that_never_hear_the_stronger_one_own_after_two_seconds)
{
    Scene weak(settings_of(3, {1, 2}, 2));
    weak.frames(0, 399);
    EXPECT_TRUE(weak.owned.empty());
    weak.frames(400, 499);
    ASSERT_FALSE(weak.owned.empty());
    EXPECT_LE(weak.owned.front().sequence, 401U);
    EXPECT_TRUE(weak.voter.owns());
}

TEST(TwoVoters, that_coast_and_wake_a_little_late_do_not_start_over)
{
    Pair pair;
    pair.frames(0, 99);
    pair.strong.until(Scene::time_of(99) + 300 * ms);
    ASSERT_EQ(pair.strong.last().vouching_mask, 0U) << "it repeats its last attitude";
    for (int wake = 0; wake < 20; ++wake) pair.strong.stopped_until(pair.strong.voter.next_deadline_ns() + 4 * ms);
    EXPECT_EQ(pair.strong.voter.counters().absences, 0U);
}

TEST(TwoVoters, lose_no_frame_at_a_cold_start)
{
    Pair pair;
    pair.frames(0, 99);
    EXPECT_EQ(pair.strong.outputs.front().sequence, 0U);
}

TEST(TwoVoters, follow_the_stronger_ones_choice_of_primary)
{
    Pair pair;
    pair.frames(0, 49, lanes_apart);
    for (std::uint64_t sequence = 50; sequence < 100; ++sequence) {
        for (std::size_t lane = 0; lane < 3; ++lane) {
            const std::int64_t time = Scene::time_of(sequence) + static_cast<std::int64_t>(lane) * ms / 10;
            AttitudeState sample = sample_of(lane, sequence);
            lanes_apart(lane, sample);
            if (lane != 0) pair.deliver(pair.strong, sample, time);  // only the strong one lost lane a
            pair.deliver(pair.weak, sample, time + ms / 50);
        }
    }
    EXPECT_EQ(pair.strong.last().primary_lane, 2U);
    EXPECT_EQ(pair.weak.last().primary_lane, 2U);
    EXPECT_EQ(pair.weak.last().reset_counter, pair.strong.last().reset_counter);
    EXPECT_EQ(pair.weak.last().output_sequence, pair.strong.last().output_sequence);
}

TEST(TwoVoters, go_on_without_a_seam_when_the_stronger_dies)
{
    Pair pair;
    pair.frames(0, 29, lanes_apart);
    pair.frames(30, 59, [](std::size_t lane, AttitudeState& sample) { return lanes_apart(lane, sample) && lane != 0; });
    const VotedAttitude last = pair.strong.last();
    ASSERT_EQ(last.reset_counter, 1U) << "something to continue";
    pair.strong_alive = false;
    pair.frames(60, 119, [](std::size_t lane, AttitudeState& sample) { return lanes_apart(lane, sample) && lane != 0; });
    for (std::uint64_t sequence = 60; sequence < 120; ++sequence) {
        const VotedAttitude* output = output_of(pair.weak, sequence);
        ASSERT_NE(output, nullptr);
        EXPECT_EQ(output->reset_counter, last.reset_counter);
        EXPECT_EQ(output->output_sequence, last.output_sequence + (sequence - last.sequence));
    }
    EXPECT_TRUE(pair.weak.voter.owns());
    EXPECT_EQ(pair.weak.count(EventCode::ownership_taken), 1U);
}

TEST(TwoVoters, announce_the_move_when_the_heir_stands_elsewhere)
{
    Pair pair;
    pair.frames(0, 49, lanes_apart);
    for (std::uint64_t sequence = 50; sequence < 80; ++sequence) {
        for (std::size_t lane = 0; lane < 3; ++lane) {
            AttitudeState sample = sample_of(lane, sequence);
            lanes_apart(lane, sample);
            pair.deliver(pair.strong, sample, Scene::time_of(sequence));
            if (lane != 0) pair.deliver(pair.weak, sample, Scene::time_of(sequence) + ms / 50);  // the weak one lost lane a
        }
    }
    ASSERT_EQ(pair.weak.last().primary_lane, 2U);
    const VotedAttitude last = pair.strong.last();
    pair.strong_alive = false;
    pair.frames(80, 99, [](std::size_t lane, AttitudeState& sample) { return lanes_apart(lane, sample) && lane != 0; });
    const VotedAttitude* next = output_of(pair.weak, 80);
    ASSERT_NE(next, nullptr);
    EXPECT_EQ(next->reset_counter, last.reset_counter + 1);
    EXPECT_NEAR(angle_between(product(next->reset_rotation, truth(80)), next->attitude), 0, 1e-12);
    EXPECT_EQ(pair.weak.last().reset_counter, last.reset_counter + 1) << "once";
}

TEST(TwoVoters, write_voted_only_after_twenty_good_frames)
{
    Pair pair;
    pair.frames(0, 99);
    for (const Scene* scene : {&pair.strong, &pair.weak}) {
        ASSERT_EQ(scene->owned.size(), 80U);
        for (std::size_t i = 0; i < 80; ++i) EXPECT_EQ(scene->owned[i].sequence, 20 + i);
    }
}

TEST(TwoVoters, let_a_starting_one_catch_up_with_the_other_before_it_writes)
{
    const VoterSettings settings = settings_of(3, {1, 2}, 1);
    const Durations durations(settings);
    OtherVoters others(settings, durations);
    OwnedStream stream(settings, durations);
    const auto writes = [&](std::uint64_t own, std::uint64_t theirs) {
        others.on_output(output_by(2, theirs, theirs + 1), 0);
        stream.push(output_by(1, own, own + 1), false, 0);
        stream.release(others, 0);
        VotedAttitude written;
        return stream.next(written);
    };
    std::uint64_t sequence = 300;
    for (; sequence < 400; ++sequence) EXPECT_FALSE(writes(sequence, sequence + 10)) << sequence;
    EXPECT_TRUE(writes(sequence + 11, sequence + 10));
}

/// A reader that has not found the stronger writer yet, or has just lost it, reads the weaker one.
TEST(TwoVoters, write_a_frame_in_the_order_of_their_strength)
{
    Pair pair;
    pair.frames(0, 99);
    const auto written = [&] { return pair.weak.owned.size(); };
    for (std::size_t lane = 0; lane < 2; ++lane) pair.weak.at(Scene::time_of(100), sample_of(lane, 100));
    ASSERT_EQ(pair.weak.last().sequence, 100U);
    EXPECT_EQ(written(), 80U) << "the stronger one has not published this frame";
    pair.exchange();
    for (std::size_t lane = 0; lane < 2; ++lane) pair.deliver(pair.strong, sample_of(lane, 100), Scene::time_of(100) + ms);
    EXPECT_EQ(written(), 81U) << "now it has";

    for (std::size_t lane = 0; lane < 2; ++lane) pair.weak.at(Scene::time_of(101), sample_of(lane, 101));
    pair.weak.until(Scene::time_of(102) - ms);
    EXPECT_EQ(written(), 81U);
    pair.weak.until(Scene::time_of(102) + ms);
    EXPECT_EQ(written(), 82U) << "an interval later without it";
}

TEST(TwoVoters, let_a_restarted_voter_continue_what_the_other_did)
{
    Pair pair;
    pair.frames(0, 49, lanes_apart);
    pair.strong_alive = false;
    pair.frames(50, 99, [](std::size_t lane, AttitudeState& sample) { return lanes_apart(lane, sample) && lane != 0; });

    Scene restarted(settings_of(3, {1, 2}, 1), Scene::time_of(100) - 3 * ms);
    std::swap(pair.strong, restarted);
    pair.strong_delivered = 0;
    pair.strong_alive = true;
    pair.frames(100, 299, [](std::size_t lane, AttitudeState& sample) { return lanes_apart(lane, sample) && lane != 0; });
    const VotedAttitude& first = pair.strong.outputs.front();
    const VotedAttitude* other = output_of(pair.weak, first.sequence);
    ASSERT_NE(other, nullptr);
    EXPECT_EQ(first.output_sequence, other->output_sequence);
    EXPECT_EQ(first.reset_counter, other->reset_counter);
    EXPECT_EQ(first.primary_lane, other->primary_lane);
    EXPECT_TRUE(pair.strong.voter.owns());
    EXPECT_FALSE(pair.weak.voter.owns());
    EXPECT_EQ(pair.weak.last().primary_lane, pair.strong.last().primary_lane);
}

/// Discovery may take longer than a lease: the lanes' samples come before the other voter's.
TEST(TwoVoters, let_one_that_starts_in_the_middle_of_a_stream_wait_for_the_other)
{
    Scene scene(settings_of(3, {1, 2}, 1), Scene::time_of(300) - 3 * ms);
    scene.frames(300, 400);
    EXPECT_TRUE(scene.outputs.empty());
    VotedAttitude other;
    other.epoch = first_epoch;
    other.unit = 7;
    other.voter = 2;
    other.primary_lane = 2;
    other.vouching_mask = 7;
    for (std::uint64_t sequence = 401; sequence <= 420; ++sequence) {
        other.sequence = sequence;
        other.output_sequence = sequence + 55;
        other.attitude = truth(sequence);
        scene.at(Scene::time_of(sequence) - ms / 10, other);
        scene.frames(sequence, sequence);
    }
    ASSERT_FALSE(scene.outputs.empty());
    for (const VotedAttitude& output : scene.outputs) EXPECT_EQ(output.output_sequence, output.sequence + 55);
    EXPECT_LE(scene.outputs.front().sequence, 412U) << "one lease after its first sample";
    EXPECT_EQ(scene.outputs.back().primary_lane, 2U);
}

TEST(TwoVoters, let_one_that_hears_no_other_go_on_alone_above_what_the_other_may_have_had)
{
    Scene scene(settings_of(3, {1, 2}, 1), Scene::time_of(300) - 3 * ms);
    scene.frames(300, 800);
    ASSERT_FALSE(scene.outputs.empty());
    EXPECT_NEAR(static_cast<double>(scene.outputs.front().sequence), 706, 6) << "after 2 s";
    EXPECT_EQ(scene.outputs.front().output_sequence, scene.outputs.front().sequence + 1);
}

TEST(TwoVoters, let_one_that_was_there_from_the_beginning_start_at_once)
{
    Scene scene(settings_of(3, {1, 2}, 1), -100 * ms);
    scene.frames(0, 10);
    ASSERT_EQ(scene.outputs.size(), 11U);
    EXPECT_EQ(scene.outputs.front().output_sequence, 1U);
}

TEST(TwoVoters, let_one_that_was_there_from_the_beginning_with_a_single_lane_start_when_that_one_is_believed)
{
    Scene scene(settings_of(3, {1, 2}, 1), -100 * ms);
    scene.frames(5, 60, [](std::size_t lane, AttitudeState& sample) {
        if (lane > 0) sample.mode = octet(AttitudeMode::initialising);
        return lane == 0 || sample.sequence >= 39;
    });
    ASSERT_FALSE(scene.outputs.empty());
    EXPECT_LE(scene.outputs.front().sequence, 30U) << "a lane alone is believed after 20 frames";
}

TEST(TwoVoters, let_one_start_at_once_when_a_lane_hands_in_the_beginning_later)
{
    Scene scene(settings_of(3, {1, 2}, 1), -100 * ms);
    scene.frames(25, 49, [](std::size_t lane, AttitudeState& sample) {
        sample.mode = octet(AttitudeMode::initialising);
        return lane == 1;
    });
    ASSERT_TRUE(scene.outputs.empty());
    for (std::uint64_t sequence = 0; sequence < 50; ++sequence) {
        for (const std::size_t lane : {0, 2}) scene.at(Scene::time_of(49) + ms, sample_of(lane, sequence));
    }
    scene.frames(50, 60);
    ASSERT_FALSE(scene.outputs.empty());
    EXPECT_LE(scene.outputs.front().sequence, 50U);
}

TEST(TwoVoters, do_not_take_the_low_number_of_a_lane_that_strays_for_the_beginning)
{
    Scene scene(settings_of(3, {1, 2}, 1), Scene::time_of(300) - 3 * ms);
    scene.frames(300, 400, [](std::size_t lane, AttitudeState& sample) {
        if (lane == 1) sample.sequence -= 297;
        return true;
    });
    EXPECT_TRUE(scene.outputs.empty());
}

TEST(TwoVoters, never_let_a_stopped_one_take_the_output_back_in_time)
{
    Pair pair;
    pair.frames(0, 99);
    pair.strong_alive = false;  // stopped, not dead: what comes meanwhile waits for it
    const std::size_t weak_before = pair.weak.outputs.size();
    pair.frames(100, 499);
    const std::size_t before = pair.strong.outputs.size();
    const std::size_t owned_before = pair.strong.owned.size();
    const std::int64_t wakes = Scene::time_of(499) + ms;
    pair.strong.stopped_until(wakes);
    for (std::uint64_t sequence = 436; sequence < 500; ++sequence) {
        for (std::size_t lane = 0; lane < 3; ++lane) pair.strong.at(wakes, sample_of(lane, sequence));
    }
    for (std::size_t output = weak_before; output < pair.weak.outputs.size(); ++output) {
        if (output + 64 >= pair.weak.outputs.size()) pair.strong.at(wakes, pair.weak.outputs[output]);
    }
    pair.weak_delivered = pair.weak.outputs.size();
    pair.strong_alive = true;
    pair.frames(500, 599);
    ASSERT_GT(pair.strong.outputs.size(), before);
    EXPECT_EQ(pair.strong.voter.counters().absences, 1U);
    for (std::size_t output = before; output < pair.strong.outputs.size(); ++output) {
        EXPECT_GE(pair.strong.outputs[output].sequence, 500U);
        EXPECT_GT(pair.strong.outputs[output].output_sequence, 500U);
    }
    ASSERT_GT(pair.strong.owned.size(), owned_before);
    EXPECT_GE(pair.strong.owned[owned_before].sequence, pair.strong.outputs[before].sequence + 20) << "twenty good frames first";
    EXPECT_EQ(pair.strong.owned.back().sequence, 599U);
}

TEST(TwoVoters, give_up_the_ownership_while_only_the_stronger_one_is_cut_off)
{
    Pair pair;
    pair.frames(0, 99);
    ASSERT_TRUE(pair.strong.voter.may_own());
    for (std::uint64_t sequence = 100; sequence < 150; ++sequence) {
        for (std::size_t lane = 0; lane < 3; ++lane) pair.deliver(pair.weak, sample_of(lane, sequence), Scene::time_of(sequence));
        pair.strong.until(Scene::time_of(sequence));
    }
    EXPECT_FALSE(pair.strong.voter.may_own());
    EXPECT_EQ(pair.strong.owned.back().sequence, 99U);
    EXPECT_TRUE(pair.weak.voter.may_own());
}

TEST(TwoVoters, listen_when_they_are_delayed_while_cut_off)
{
    Pair pair;
    pair.frames(0, 99);
    for (std::uint64_t sequence = 100; sequence < 150; ++sequence) {
        for (std::size_t lane = 0; lane < 3; ++lane) pair.deliver(pair.weak, sample_of(lane, sequence), Scene::time_of(sequence));
        pair.strong.until(Scene::time_of(sequence));
    }
    ASSERT_EQ(pair.strong.voter.state(), VoterState::cut_off);
    pair.strong.stopped_until(Scene::time_of(149) + 200 * ms);
    EXPECT_EQ(pair.strong.voter.state(), VoterState::listening);
    EXPECT_TRUE(pair.strong.states.arrows().contains({"cut_off", "listening"}));
}

TEST(TwoVoters, ignore_strangers_and_their_own_samples)
{
    Scene scene(settings_of(3, {1, 2}, 1));
    scene.frames(0, 49);
    VotedAttitude stranger = scene.last();
    stranger.voter = 9;
    stranger.output_sequence = 1'000'000;
    scene.at(scene.now, stranger);
    VotedAttitude own = scene.last();
    own.output_sequence = 2'000'000;
    scene.at(scene.now, own);
    scene.frames(50, 59);
    EXPECT_EQ(scene.last().output_sequence, 60U);
}
