#include "start.hpp"

#include "quorient/messages/meaning.hpp"
#include "state_diagram.hpp"

#include <gtest/gtest.h>
#include <functional>
#include <ostream>

namespace quorient::attitude {

void PrintTo(StartState state, std::ostream* stream)
{
    *stream << to_string(state);
}

namespace {

void take_over(Start& start, std::uint64_t sequence = 7)
{
    VotedAttitude voted;
    voted.epoch = 1;
    voted.sequence = sequence;
    start.wait_for(voted);
    start.on_seed_connected();
}

/// A start that has come to this state.
Start in(StartState state)
{
    Start start(state == StartState::aligned);
    if (state == StartState::aligning) start.on_reset();
    if (state == StartState::taking_over || state == StartState::seeded) take_over(start);
    if (state == StartState::seeded) start.on_caught_up();
    EXPECT_EQ(start.state(), state);
    return start;
}

TEST(Start, changes_its_state_as_the_diagram_in_the_readme_shows)
{
    const std::vector<std::function<void(Start&)>> events{
        [](Start& start) { start.on_caught_up(); },
        [](Start& start) { start.on_reset(); },
        [](Start& start) { start.on_stated_epoch(); },
        [](Start& start) { take_over(start); },
        [](Start& start) {
            if (start.state() == StartState::taking_over) start.on_lost_track();  // frames are missing right after a seed
        },
    };
    std::set<test::Arrow> arrows;
    for (const StartState from : all_start_states) {
        for (const auto& event : events) {
            Start start = in(from);
            event(start);
            if (start.state() != from) arrows.emplace(to_string(from), to_string(start.state()));
        }
    }
    EXPECT_EQ(arrows, test::state_diagram(QUORIENT_SOURCE_DIR "/common/attitude/README.md"));
}

TEST(Start, publishes_no_attitude_before_the_newest_frame_is_integrated)
{
    EXPECT_TRUE(in(StartState::waiting).is_initialising());
    EXPECT_TRUE(in(StartState::taking_over).is_initialising());
    EXPECT_TRUE(in(StartState::aligning).is_initialising());
    EXPECT_FALSE(in(StartState::aligned).is_initialising());
    EXPECT_FALSE(in(StartState::seeded).is_initialising());
}

TEST(Start, waits_for_one_seed_until_it_connects_is_dropped_or_a_command_comes)
{
    VotedAttitude voted;
    voted.sequence = 9;
    Start start(false);
    EXPECT_EQ(start.waiting_seed(), nullptr);
    start.wait_for(voted);
    ASSERT_NE(start.waiting_seed(), nullptr);
    start.on_seed_connected();
    EXPECT_EQ(start.waiting_seed(), nullptr);
    EXPECT_EQ(start.seed_frame().sequence, 9u);

    start.wait_for(voted);
    start.drop_seed();
    EXPECT_EQ(start.waiting_seed(), nullptr);
    start.wait_for(voted);
    start.on_reset();
    EXPECT_EQ(start.waiting_seed(), nullptr) << "an order is newer than the seed";
}

TEST(Start, asks_once_after_an_absence_and_only_a_voted_attitude_from_after_it)
{
    VotedAttitude before;
    before.epoch = 1;
    before.sequence = 29;
    VotedAttitude after = before;
    after.sequence = 30;
    Start start(true);
    EXPECT_FALSE(start.ends_absence(after)) << "there was none";
    start.on_absence({1, 30});
    EXPECT_FALSE(start.ends_absence(before));
    EXPECT_TRUE(start.ends_absence(after));
    EXPECT_FALSE(start.ends_absence(after)) << "once";
}

}  // namespace
}  // namespace quorient::attitude
