// A voter of which one frame in four comes, since it or its lanes are overloaded.

#include "scene.hpp"

#include <gtest/gtest.h>

using namespace quorient;
using namespace quorient::voting;
using namespace quorient::voting::test;

namespace {

constexpr unsigned one_in = 4;

struct Paced {
    Paced()
    {
        scene.frames(0, 99);
        scene.voter.keep_pace(one_in);
        scene.outputs.clear();
        scene.events.clear();
    }

    /// Every fourth frame from `first` on, `count` of them, each lane this much later than the one before; the voter is polled between them.
    void kept_frames(std::uint64_t first, std::uint64_t count, std::int64_t apart_ns)
    {
        for (std::uint64_t sequence = first; sequence < first + one_in * count; sequence += one_in) {
            for (std::size_t lane = 0; lane < 3; ++lane)
                scene.at(Scene::time_of(sequence) + static_cast<std::int64_t>(lane) * apart_ns, sample_of(lane, sequence));
            scene.voter.poll(scene.now);
            scene.collect();
        }
    }

    Scene scene;
};

TEST(APacedVoter, takes_no_lane_as_silent_and_repeats_nothing)
{
    Paced paced;
    paced.kept_frames(100, 100, 4 * ms);
    ASSERT_EQ(paced.scene.outputs.size(), 100U);
    for (std::size_t i = 0; i < 100; ++i) {
        EXPECT_EQ(paced.scene.outputs[i].sequence, 100 + one_in * i);
        EXPECT_EQ(paced.scene.outputs[i].level, octet(VoteLevel::full));
    }
    EXPECT_EQ(paced.scene.count(EventCode::lane_excluded), 0U);
    EXPECT_EQ(paced.scene.count(EventCode::level_changed), 0U);
}

TEST(APacedVoter, gives_out_the_newest_frame_of_a_backlog_alone)
{
    Paced paced;
    const std::int64_t late = Scene::time_of(106);  // less than a silence after the last frame
    for (std::uint64_t sequence = 100; sequence <= 104; sequence += one_in) {
        for (std::size_t lane = 0; lane < 3; ++lane) paced.scene.at(late, sample_of(lane, sequence));
    }
    EXPECT_TRUE(paced.scene.outputs.empty()) << "nothing before everything is read";
    paced.scene.voter.poll(paced.scene.now);
    paced.scene.collect();
    ASSERT_EQ(paced.scene.outputs.size(), 1U);
    EXPECT_EQ(paced.scene.last().sequence, 104U);
    EXPECT_EQ(paced.scene.error_rad(), 0);
}

TEST(AVoterThatIsNotPaced, gives_out_every_frame_of_a_backlog)
{
    Scene scene;
    scene.frames(0, 99);
    scene.outputs.clear();
    const std::int64_t late = Scene::time_of(104);
    for (std::uint64_t sequence = 100; sequence <= 104; ++sequence) {
        for (std::size_t lane = 0; lane < 3; ++lane) scene.at(late, sample_of(lane, sequence));
    }
    scene.until(late + interval);
    std::set<std::uint64_t> frames;
    for (const auto& output : scene.outputs) frames.insert(output.sequence);
    EXPECT_EQ(frames, (std::set<std::uint64_t>{100, 101, 102, 103, 104}));
}

TEST(APacedVoter, still_finds_that_a_lane_is_silent)
{
    Paced paced;
    for (std::uint64_t sequence = 100; sequence < 200; sequence += one_in) {
        for (std::size_t lane = 0; lane < 2; ++lane) paced.scene.at(Scene::time_of(sequence), sample_of(lane, sequence));
        paced.scene.voter.poll(paced.scene.now);
        paced.scene.collect();
    }
    EXPECT_EQ(paced.scene.why(2), LaneExclusion::silent);
    EXPECT_EQ(paced.scene.last().level, octet(VoteLevel::degraded));
}

/// Readers of `voted` take another voter as soon as its lease has passed in silence.
TEST(APacedVoter, that_has_no_frames_coasts_before_its_lease_ends)
{
    Paced paced;
    paced.scene.until(Scene::time_of(99) + 38 * ms);
    EXPECT_TRUE(paced.scene.outputs.empty());
    paced.scene.until(Scene::time_of(99) + 48 * ms);
    ASSERT_FALSE(paced.scene.outputs.empty());
    EXPECT_EQ(paced.scene.last().level, octet(VoteLevel::coasting));
}

TEST(APacedVoter, gives_out_every_frame_again_once_all_of_them_come)
{
    Paced paced;
    paced.kept_frames(100, 25, ms);
    paced.scene.voter.keep_pace(1);
    paced.scene.outputs.clear();
    paced.scene.frames(200, 299);
    ASSERT_EQ(paced.scene.outputs.size(), 100U);
    EXPECT_EQ(paced.scene.last().level, octet(VoteLevel::full));
}

}  // namespace
