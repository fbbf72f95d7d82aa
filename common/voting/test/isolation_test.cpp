// What lanes and detectors say of a sensor fault, and what the voter makes of it.
#include "scene.hpp"
#include "quorient/messages/meaning.hpp"

#include <gtest/gtest.h>

using namespace quorient;
using namespace quorient::voting;
using namespace quorient::voting::test;

namespace {

constexpr AxisMask axis_2 = 0b100;

/// A fault on axis 2 from frame 50 on turns every lane that still uses the axis by `drift_rad` per frame; each lane's detector suspects
/// and isolates it in its own time, and from then on the lane is right again.
struct Fault {
    std::array<std::uint64_t, 3> suspected{};
    std::array<std::uint64_t, 3> isolated{};
    double drift_rad = 1e-3;

    AttitudeState sample(std::size_t lane, std::uint64_t sequence) const
    {
        AttitudeState made = sample_of(lane, sequence);
        if (sequence >= isolated[lane]) {
            made = isolating(made, axis_2);
            made.reset_counter = 1;
            made.reset_rotation = turn(-drift_rad * static_cast<double>(isolated[lane] - 50));
        } else if (sequence >= 50) {
            made = moved(made, drift_rad * static_cast<double>(sequence - 49));
        }
        return made;
    }

    FaultVerdict verdict(std::size_t lane, std::uint64_t sequence) const
    {
        if (sequence >= isolated[lane]) return verdict_of(lane, sequence, VerdictState::isolated, axis_2);
        return verdict_of(lane, sequence, sequence >= suspected[lane] ? VerdictState::suspect : VerdictState::healthy, axis_2);
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

/// Suspected by every detector from frame 50 on.
Fault isolated_by_all(std::uint64_t from)
{
    Fault fault;
    fault.suspected.fill(50);
    fault.isolated.fill(from);
    return fault;
}

std::size_t changes(const Scene& scene)
{
    return scene.voter.counters().primary_changes;
}

}  // namespace

TEST(Isolation, seen_by_one_detector_alone_cannot_move_the_output)
{
    for (const std::size_t dreamer : {std::size_t{0}, std::size_t{2}}) {
        Scene scene;
        Fault imagined;
        imagined.suspected = imagined.isolated = {never, never, never};
        imagined.suspected[dreamer] = 50;
        imagined.isolated[dreamer] = 52;
        imagined.drift_rad = 0;
        imagined.play(scene, 0, 52);
        for (std::uint64_t sequence = 53; sequence < 200; ++sequence) {
            for (std::size_t lane = 0; lane < 3; ++lane) {
                scene.at(Scene::time_of(sequence), imagined.verdict(lane, sequence));
                AttitudeState sample = imagined.sample(lane, sequence);
                scene.at(Scene::time_of(sequence), lane == dreamer ? moved(sample, 0.3) : sample);
            }
        }
        for (const VotedAttitude& output : scene.outputs) EXPECT_EQ(output.attitude, truth(output.sequence));
        EXPECT_EQ(scene.last().isolated_mask, 0U);
        EXPECT_EQ(scene.why(dreamer), LaneExclusion::uncorroborated);
        EXPECT_LE(changes(scene), dreamer == 0 ? 1U : 0U);
    }
}

TEST(Isolation, that_a_second_detector_suspects_moves_the_output_at_once)
{
    Scene scene;
    Fault fault;
    fault.suspected = {53, 51, 50};
    fault.isolated = {58, 56, 52};  // lane c is first; b suspects already
    fault.play(scene, 0, 99);
    for (const VotedAttitude& output : scene.outputs) {
        if (output.sequence < 53) continue;  // c's sample is the last: frame 52 went out before it
        EXPECT_EQ(output.attitude, truth(output.sequence)) << "frame " << output.sequence;
    }
    EXPECT_EQ(changes(scene), 1U);
    EXPECT_EQ(scene.last().primary_lane, 3U);
    EXPECT_EQ(scene.last().isolated_mask, axis_2);
    EXPECT_EQ(scene.last().excluded_mask, 0U);
    EXPECT_EQ(scene.voter.level(), VoteLevel::full);
}

TEST(Isolation, of_the_primary_first_keeps_it_primary_while_the_others_suspect)
{
    Scene scene;
    Fault fault;
    fault.suspected = {50, 51, 51};
    fault.isolated = {52, 55, 57};
    fault.play(scene, 0, 99);
    EXPECT_EQ(changes(scene), 0U);
    EXPECT_EQ(scene.last().reset_counter, 1U);
    EXPECT_EQ(scene.error_rad(), 0);
}

TEST(Isolation, that_came_first_and_rightly_is_never_expelled_by_two_late_ones)
{
    for (const std::uint64_t late : {55UL, 65UL, 100UL, 400UL}) {
        for (std::size_t first = 0; first < 3; ++first) {
            Scene scene;
            Fault fault;
            fault.suspected = {late - 2, late - 2, late - 2};
            fault.isolated = {late, late, late};
            fault.suspected[first] = 50;
            fault.isolated[first] = 52;
            fault.drift_rad = 1e-4;
            fault.play(scene, 0, late + 99);
            for (const VotedAttitude& output : scene.outputs) {
                EXPECT_NE(output.excluded_why[first], octet(LaneExclusion::disagrees))
                    << "late by " << late - 52;
                if (output.sequence < late - 2) continue;
                EXPECT_EQ(output.attitude, truth(output.sequence)) << "from the frame on that a second detector suspects";
            }
            EXPECT_EQ(scene.voter.level(), VoteLevel::full);
        }
    }
}

TEST(Isolation, keeps_the_corrected_primary_while_the_others_have_yet_to_correct_themselves)
{
    Scene scene;
    Fault fault;
    fault.suspected = {50, 51, 51};
    fault.isolated = {52, 53, 53};
    for (std::uint64_t sequence = 0; sequence < 100; ++sequence) {
        for (std::size_t lane = 0; lane < 3; ++lane) {
            AttitudeState sample = fault.sample(lane, sequence);
            const bool rolling_back = lane != 0 && sequence >= 53 && sequence < 59;
            scene.at(Scene::time_of(sequence), fault.verdict(lane, sequence));
            scene.at(Scene::time_of(sequence), rolling_back ? moved(sample, 3e-3) : sample);
        }
    }
    for (const VotedAttitude& output : scene.outputs) {
        if (output.sequence < 52) continue;
        EXPECT_EQ(output.attitude, truth(output.sequence)) << "frame " << output.sequence;
    }
    EXPECT_EQ(changes(scene), 0U);
    EXPECT_EQ(scene.last().excluded_mask, 0U);
}

TEST(Isolation, of_a_majority_outvotes_the_lane_that_keeps_the_axis)
{
    Scene scene;
    Fault fault;
    fault.suspected = {never, 50, 50};
    fault.isolated = {never, 52, 52};
    fault.play(scene, 0, 99);
    EXPECT_EQ(scene.why(0), LaneExclusion::outvoted);
    EXPECT_EQ(scene.error_rad(), 0);
    EXPECT_EQ(scene.voter.level(), VoteLevel::degraded);
}

TEST(Isolation, stays_corroborated_when_the_detectors_die)
{
    Scene scene;
    Fault fault;
    fault.suspected = {50, 50, 50};
    fault.isolated = {52, 52, 52};
    fault.play(scene, 0, 99);
    for (std::uint64_t sequence = 100; sequence < 200; ++sequence) {
        for (std::size_t lane = 0; lane < 3; ++lane) {
            AttitudeState sample = fault.sample(lane, sequence);
            if (lane == 0) {
                sample = moved(sample_of(0, sequence), 0.2);  // a restart forgot the latch
            }
            scene.at(Scene::time_of(sequence), sample);
        }
    }
    EXPECT_EQ(scene.why(0), LaneExclusion::outvoted);
    EXPECT_EQ(scene.error_rad(), 0);
}

TEST(Isolation, of_a_majority_that_is_late_is_waited_for_in_place_of_the_lane_that_keeps_the_axis)
{
    Scene scene;
    Fault fault;
    fault.suspected = {50, 50, never};
    fault.isolated = {52, 52, never};  // lane c's detector is dead
    fault.play(scene, 0, 99);
    for (std::uint64_t sequence = 100; sequence < 200; ++sequence) {
        scene.at(Scene::time_of(sequence), fault.sample(2, sequence));
        // The others' samples of this frame come two intervals late.
        for (std::size_t lane = 0; lane < 2; ++lane) scene.at(Scene::time_of(sequence) + ms / 10, fault.sample(lane, sequence - 2));
    }
    for (const VotedAttitude& output : scene.outputs) {
        if (output.sequence < 52) continue;
        EXPECT_LT(angle_between(output.attitude, truth(output.sequence)), 1e-9) << "frame " << output.sequence;
    }
    EXPECT_GE(scene.last().sequence, 197U);
}

TEST(Isolation, of_lanes_that_have_died_no_longer_holds_the_last_one_back)
{
    Scene scene;
    Fault fault;
    fault.suspected = {50, 50, never};
    fault.isolated = {52, 52, never};
    fault.play(scene, 0, 99);
    for (std::uint64_t sequence = 100; sequence < 150; ++sequence) scene.at(Scene::time_of(sequence), fault.sample(2, sequence));
    EXPECT_EQ(scene.last().primary_lane, 3U);
    EXPECT_EQ(scene.voter.level(), VoteLevel::single);
}

/// Frames that all lanes published before they isolated are never corrected: they go out, contaminated for as long as isolation took.
TEST(Isolation, that_verdicts_tell_before_the_frames_arrive_leaves_no_frame_out)
{
    for (const std::uint64_t applied : {52U, 53U}) {
        Scene scene;
        const Fault reported = isolated_by_all(52), made = isolated_by_all(applied);
        for (std::uint64_t sequence = 1; sequence < 100; ++sequence) {
            for (std::size_t lane = 0; lane < 3; ++lane) scene.at(Scene::time_of(sequence), reported.verdict(lane, sequence));
            for (std::size_t lane = 0; lane < 3; ++lane) scene.at(Scene::time_of(sequence) + 2 * ms, made.sample(lane, sequence - 1));
        }
        ASSERT_EQ(scene.outputs.size(), 99U) << "applied from frame " << applied << " on";
        for (const VotedAttitude& output : scene.outputs) {
            const std::uint64_t sequence = output.sequence;
            const double allowed_rad = sequence < 50 || sequence >= applied ? 0 : made.drift_rad * static_cast<double>(sequence - 49);
            EXPECT_LE(angle_between(output.attitude, truth(sequence)), allowed_rad + 1e-9) << "frame " << sequence;
        }
    }
}

TEST(Isolation, that_detectors_tell_and_no_lane_ever_applies_is_never_put_out)
{
    Scene scene;
    const Fault reported = isolated_by_all(52), made = isolated_by_all(never);
    for (std::uint64_t sequence = 0; sequence < 100; ++sequence) {
        for (std::size_t lane = 0; lane < 3; ++lane) scene.at(Scene::time_of(sequence), reported.verdict(lane, sequence));
        for (std::size_t lane = 0; lane < 3; ++lane) scene.at(Scene::time_of(sequence), made.sample(lane, sequence));
    }
    EXPECT_EQ(scene.last().sequence, 51U);
    EXPECT_NE(scene.voter.level(), VoteLevel::full);
}

TEST(Isolation, by_candidates_of_another_detector_counts)
{
    for (const bool named : {true, false}) {
        Scene scene;
        for (std::uint64_t sequence = 0; sequence < 100; ++sequence) {
            for (std::size_t lane = 0; lane < 3; ++lane) {
                const bool fault = sequence >= 50;
                FaultVerdict verdict =
                    verdict_of(lane, sequence, fault && lane == 2 ? VerdictState::isolated : VerdictState::healthy, axis_2);
                if (fault && lane == 1) {
                    verdict.state = octet(VerdictState::ambiguous);
                    verdict.candidate_set[0] = 0b001;
                    verdict.candidate_set[1] = named ? axis_2 : 0b010;
                    verdict.candidate_count = 2;
                }
                scene.at(Scene::time_of(sequence), verdict);
                scene.at(Scene::time_of(sequence),
                         fault && lane == 2 ? isolating(sample_of(2, sequence), axis_2) : sample_of(lane, sequence));
            }
        }
        EXPECT_EQ(scene.last().primary_lane, named ? 3U : 1U);
    }
}

TEST(Isolation, is_waited_for_before_the_output_moves_away_from_its_primary)
{
    Scene scene;
    Fault fault;
    fault.suspected = {50, 52, 52};
    fault.isolated = {52, 54, 54};
    for (std::uint64_t sequence = 0; sequence < 100; ++sequence) {
        for (std::size_t lane = 0; lane < 3; ++lane) scene.at(Scene::time_of(sequence), fault.sample(lane, sequence));
        for (std::size_t lane = 0; lane < 3; ++lane) scene.at(Scene::time_of(sequence) + 2 * ms, fault.verdict(lane, sequence));
    }
    EXPECT_EQ(changes(scene), 0U) << "the verdicts of frame 52 come after its attitudes";
    EXPECT_EQ(scene.error_rad(), 0);
}

TEST(Suspicion, protects_from_exclusion_until_settle_time)
{
    for (const bool suspected : {true, false}) {
        Scene scene;
        for (std::uint64_t sequence = 0; sequence < 75; ++sequence) {
            for (std::size_t lane = 0; lane < 3; ++lane) {
                const bool trouble = suspected && sequence >= 49 && sequence < 60;
                scene.at(Scene::time_of(sequence),
                         verdict_of(lane, sequence, trouble ? VerdictState::suspect : VerdictState::healthy, axis_2));
                scene.at(Scene::time_of(sequence),
                         lane == 2 && sequence >= 50 && sequence < 68 ? moved(sample_of(2, sequence), 0.01) : sample_of(lane, sequence));
            }
        }
        EXPECT_EQ(scene.count(EventCode::lane_excluded), suspected ? 0U : 1U);
        EXPECT_EQ(scene.excluded(2), !suspected);
    }
}

TEST(Suspicion, that_settled_protects_no_longer)
{
    Scene scene;
    for (std::uint64_t sequence = 0; sequence < 100; ++sequence) {
        for (std::size_t lane = 0; lane < 3; ++lane) {
            const bool trouble = sequence >= 49 && sequence < 60;
            scene.at(Scene::time_of(sequence), verdict_of(lane, sequence, trouble ? VerdictState::suspect : VerdictState::healthy, axis_2));
            scene.at(Scene::time_of(sequence),
                     lane == 2 && sequence >= 50 ? moved(sample_of(2, sequence), 0.01) : sample_of(lane, sequence));
        }
    }
    EXPECT_EQ(scene.why(2), LaneExclusion::disagrees);
}

TEST(Suspicion, restarts_no_return)
{
    for (const bool suspected : {true, false}) {
        Scene scene;
        for (std::uint64_t sequence = 0; sequence < 330; ++sequence) {
            for (std::size_t lane = 0; lane < 3; ++lane) {
                const bool trouble = suspected && sequence >= 198 && sequence < 203;
                scene.at(Scene::time_of(sequence),
                         verdict_of(lane, sequence, trouble ? VerdictState::suspect : VerdictState::healthy, axis_2));
                if (lane == 1 && sequence >= 50 && sequence < 100) continue;
                scene.at(Scene::time_of(sequence),
                         lane == 1 && sequence == 200 ? moved(sample_of(1, sequence), 0.01) : sample_of(lane, sequence));
            }
        }
        EXPECT_EQ(scene.excluded(1), !suspected);
    }
}

TEST(Suspicion, of_one_detector_for_ever_protects_its_lane_only_for_a_while)
{
    Scene scene;
    for (std::uint64_t sequence = 0; sequence < 150; ++sequence) {
        for (std::size_t lane = 0; lane < 3; ++lane) {
            const bool trouble = lane == 2 && sequence >= 50 && sequence % 4 < 2;
            scene.at(Scene::time_of(sequence), verdict_of(lane, sequence, trouble ? VerdictState::suspect : VerdictState::healthy, axis_2));
            scene.at(Scene::time_of(sequence),
                     lane == 2 && sequence >= 50 ? moved(sample_of(2, sequence), 0.01) : sample_of(lane, sequence));
        }
    }
    EXPECT_EQ(scene.why(2), LaneExclusion::disagrees);
}

TEST(Verdicts, that_are_old_or_of_no_frame_yet_change_nothing)
{
    Scene scene;
    Fault fault;
    fault.suspected = fault.isolated = {never, never, never};
    fault.drift_rad = 0;
    fault.play(scene, 0, 60);
    for (const std::size_t lane : {std::size_t{0}, std::size_t{1}}) {
        scene.at(scene.now, verdict_of(lane, 20, VerdictState::isolated, axis_2));
        scene.at(scene.now, verdict_of(lane, 5000, VerdictState::isolated, axis_2));
    }
    for (std::uint64_t sequence = 61; sequence < 100; ++sequence) {
        for (std::size_t lane = 0; lane < 3; ++lane) {
            scene.at(Scene::time_of(sequence), fault.verdict(lane, sequence));
            scene.at(Scene::time_of(sequence),
                     lane == 2 ? moved(isolating(sample_of(2, sequence), axis_2), 0.1) : sample_of(lane, sequence));
        }
    }
    EXPECT_EQ(scene.error_rad(), 0);
    EXPECT_EQ(scene.why(2), LaneExclusion::uncorroborated);
}
