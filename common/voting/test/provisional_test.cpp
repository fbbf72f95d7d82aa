// Lanes with dissimilar detectors leave out different axes for a time. None of them is wrong because of that alone.
#include "quorient/messages/meaning.hpp"
#include "scene.hpp"

#include <gtest/gtest.h>
#include <algorithm>

using namespace quorient;
using namespace quorient::voting;
using namespace quorient::voting::test;

namespace {

constexpr AxisMask axis_1 = 0b010;
constexpr AxisMask axis_2 = 0b100;
constexpr std::uint64_t onset = 50;

/// A fault on axis 2 from frame 50 on turns every lane that uses the axis by 1 mrad per frame. Each lane leaves the axis out in its own
/// time, goes back to the onset, and is right again.
struct Disturbance {
    std::array<std::uint64_t, 3> left_out_from{};
    std::array<std::uint64_t, 3> suspected_from{never, never, never};
    std::uint64_t suspected_until = never;
    std::uint64_t end = never;  ///< from this frame on the axis agrees again, and is used by all
    bool is_told = true;        ///< false: the lanes deviate alike, without naming an axis

    bool leaves_out(std::size_t lane, std::uint64_t sequence) const { return sequence >= left_out_from[lane] && sequence < end; }

    AttitudeState sample(std::size_t lane, std::uint64_t sequence) const
    {
        AttitudeState made = sample_of(lane, sequence);
        if (leaves_out(lane, sequence) && is_told) made = leaving_out(made, axis_2, onset);
        if (sequence >= left_out_from[lane]) {
            made.reset_counter = 1;
            made.reset_rotation = turn(-1e-3 * static_cast<double>(left_out_from[lane] - onset));
        } else if (sequence >= onset) {
            made = moved(made, 1e-3 * static_cast<double>(sequence - onset + 1));
        }
        return made;
    }

    FaultVerdict verdict(std::size_t lane, std::uint64_t sequence) const
    {
        if (leaves_out(lane, sequence) && is_told) return verdict_of(lane, sequence, VerdictState::provisional, axis_2);
        const bool suspects = sequence >= suspected_from[lane] && sequence < std::min(left_out_from[lane], suspected_until);
        return verdict_of(lane, sequence, suspects ? VerdictState::suspect : VerdictState::healthy, axis_2);
    }

    void play(Scene& scene, std::uint64_t first, std::uint64_t last) const
    {
        for (std::uint64_t sequence = first; sequence <= last; ++sequence) {
            for (std::size_t lane = 0; lane < 3; ++lane) {
                const std::int64_t time = Scene::time_of(sequence) + static_cast<std::int64_t>(lane) * ms / 10;
                scene.at(time, verdict(lane, sequence));
                scene.at(time, sample(lane, sequence));
            }
        }
    }
};

double largest_error(const Scene& scene, std::uint64_t first, std::uint64_t last)
{
    double largest = 0;
    for (const VotedAttitude& output : scene.outputs) {
        if (output.sequence < first || output.sequence > last) continue;
        largest = std::max(largest, angle_between(output.attitude, truth(output.sequence)));
    }
    return largest;
}

bool was_ever_excluded(const Scene& scene, std::size_t lane)
{
    return std::any_of(scene.outputs.begin(), scene.outputs.end(),
                       [lane](const VotedAttitude& output) { return (output.excluded_mask >> lane & 1U) != 0; });
}

}  // namespace

TEST(ProvisionalExclusion, of_different_axes_leaves_all_lanes_in_the_vote)
{
    Scene scene;
    scene.frames(0, 149, [](std::size_t lane, AttitudeState& sample) {
        if (sample.sequence >= 50 && lane == 0) sample = leaving_out(sample, axis_1, 45);
        if (sample.sequence >= 60 && lane == 1) sample = moved(leaving_out(sample, axis_2, 55), 5e-5);
        return true;
    });
    EXPECT_EQ(scene.last().sequence, 149u);
    EXPECT_EQ(level_of(scene.last()), VoteLevel::full);
    EXPECT_EQ(scene.last().vouching_mask, 0b111u);
    EXPECT_EQ(scene.last().isolated_mask, 0u);
    EXPECT_EQ(provisional_mask(scene.last()), axis_1) << "as the primary has it";
    for (std::size_t lane = 0; lane < 3; ++lane) EXPECT_FALSE(was_ever_excluded(scene, lane)) << lane;
    EXPECT_EQ(scene.voter.counters().primary_changes, 0u);
}

TEST(ProvisionalExclusion, and_an_isolation_of_the_same_axis_vouch_for_each_other)
{
    Scene scene;
    for (std::uint64_t sequence = 0; sequence < 150; ++sequence) {
        for (std::size_t lane = 0; lane < 3; ++lane) {
            const std::int64_t time = Scene::time_of(sequence) + static_cast<std::int64_t>(lane) * ms / 10;
            const bool isolates = lane == 1;
            const bool faulty = sequence >= onset;
            const VerdictState state = isolates ? VerdictState::isolated : VerdictState::provisional;
            scene.at(time, verdict_of(lane, sequence, faulty ? state : VerdictState::healthy, axis_2));
            AttitudeState sample = sample_of(lane, sequence);
            if (faulty) sample = leaving_out(isolates ? isolating(sample, axis_2) : sample, axis_2, onset);
            scene.at(time, sample);
        }
    }
    EXPECT_EQ(level_of(scene.last()), VoteLevel::full);
    EXPECT_EQ(scene.last().vouching_mask, 0b111u);
    for (std::size_t lane = 0; lane < 3; ++lane) EXPECT_FALSE(was_ever_excluded(scene, lane)) << lane;
}

TEST(ProvisionalExclusion, found_first_by_the_primary_is_not_outvoted_by_lanes_that_only_suspect_yet)
{
    Scene scene;
    Disturbance disturbance{{onset, onset + 8, onset + 8}};
    disturbance.suspected_from = {never, onset, onset};
    disturbance.play(scene, 0, 299);
    EXPECT_LT(largest_error(scene, 0, 299), 1e-9) << "the primary never had the fault";
    for (std::size_t lane = 0; lane < 3; ++lane) EXPECT_FALSE(was_ever_excluded(scene, lane)) << lane;
    EXPECT_EQ(scene.voter.counters().primary_changes, 0u);
    EXPECT_EQ(level_of(scene.last()), VoteLevel::full);
}

TEST(ProvisionalExclusion, is_what_keeps_the_primary_there_for_without_it_the_majority_wins)
{
    Scene scene;
    Disturbance disturbance{{onset, onset + 8, onset + 8}};
    disturbance.suspected_from = {never, onset, onset};
    disturbance.is_told = false;
    disturbance.play(scene, 0, 100);
    EXPECT_GT(scene.voter.counters().primary_changes, 0u);
    EXPECT_GT(largest_error(scene, onset, onset + 8), 1e-3);
}

TEST(ProvisionalExclusion, found_by_a_majority_moves_the_output_at_once_and_excludes_no_lane_that_is_late)
{
    Scene scene;
    const Disturbance disturbance{{onset + 20, onset, onset}};
    disturbance.play(scene, 0, 399);
    EXPECT_LT(largest_error(scene, 0, 399), 1e-9);
    EXPECT_FALSE(was_ever_excluded(scene, 0)) << "it uses an axis that the others leave out: no comparison";
    EXPECT_EQ(scene.voter.counters().primary_changes, 1u);
    EXPECT_EQ(level_of(scene.last()), VoteLevel::full);
}

TEST(ProvisionalExclusion, that_no_other_detector_reports_neither_holds_the_output_nor_excludes_its_lane)
{
    Scene scene;
    Disturbance alone{{onset, never, never}};  // the voter cannot know whether the one lane is right, or the two
    alone.play(scene, 0, 90);
    EXPECT_GT(largest_error(scene, onset, onset + 1), 1e-3) << "the majority decides, as it does without the exclusion";
    EXPECT_FALSE(was_ever_excluded(scene, 0));
    EXPECT_EQ(scene.voter.counters().primary_changes, 1u);

    Scene unnamed;
    alone.is_told = false;
    alone.play(unnamed, 0, 90);
    EXPECT_TRUE(was_ever_excluded(unnamed, 0)) << "a lane that is apart and names no axis disagrees";
}

TEST(ProvisionalExclusion, holds_the_output_only_while_a_second_detector_reports_the_axis)
{
    Scene scene;
    Disturbance disturbance{{onset, never, never}};
    disturbance.suspected_from = {never, onset, never};
    disturbance.suspected_until = onset + 20;
    disturbance.play(scene, 0, 90);
    EXPECT_LT(largest_error(scene, 0, onset + 19), 1e-9);
    EXPECT_GT(largest_error(scene, onset + 21, 90), 1e-3);
    EXPECT_FALSE(was_ever_excluded(scene, 0));
}

TEST(ProvisionalExclusion, and_its_end_leave_the_stream_without_a_step)
{
    Scene scene;
    Disturbance passing{{onset, onset + 2, onset + 4}};
    passing.suspected_from = {never, onset, onset};
    passing.end = onset + 60;
    passing.play(scene, 0, 199);
    EXPECT_LT(largest_error(scene, 0, 199), 1e-9);
    EXPECT_EQ(scene.last().used_mask, 0x3fu);
    EXPECT_EQ(provisional_mask(scene.last()), 0u);
    EXPECT_EQ(scene.last().excluded_mask, 0u);
    EXPECT_EQ(level_of(scene.last()), VoteLevel::full);
}
