// Rule-based random tests: a world of lanes, detectors and voters is driven by random events; rules that must hold whatever happens are
// checked at every output. A sequence that breaks one is shrunk and printed.
//
// QUORIENT_RANDOM_SEQUENCES sets how many sequences are tried in all (default 5000), QUORIENT_RANDOM_SEED the first seed.
#include "random_world.hpp"

#include <gtest/gtest.h>
#include <algorithm>
#include <array>
#include <map>
#include <optional>
#include <set>

using namespace quorient;
using namespace quorient::voting;
using namespace quorient::voting::test;

TEST(RandomEvents, of_every_kind_never_break_what_an_output_is)
{
    hold(
        [](Random& random) {
            return mixed(random, 60, 4,
                         {Happening::kill, Happening::revive, Happening::revive, Happening::lie, Happening::honest, Happening::sensor_fault,
                          Happening::readmit, Happening::pause, Happening::restart_publisher, Happening::stall});
        },
        [](const Events& events) {
            World world({.lanes = 1 + events.size() % 5, .jitter_us = 9000});
            for (const Event& event : events) {
                world.play(event);
                if (!world.problem().empty()) break;
            }
            return world.problem();
        });
}

TEST(RandomEvents, let_one_lying_lane_of_three_move_nothing_by_more_than_the_agreement)
{
    constexpr double gate_rad = 1e-4 + 5 * 1.41421356237 * 1e-5 + 1e-6;
    hold(
        [](Random& random) {
            const std::uint32_t liar = random() % 3;
            Events events = mixed(random, 50, 6, {Happening::lie, Happening::lie, Happening::honest});
            for (Event& event : events) event.where = liar;
            return events;
        },
        [](const Events& events) {
            World world({});
            std::uint64_t expected = 0;
            world.on_output = [&](std::size_t, const VotedAttitude& now) {
                world.watch().expect(now.vouching_mask != 0, "it coasts although two lanes are there");
                world.watch().expect(now.sequence == expected, "a frame is missing");
                world.watch().expect(now.epoch == first_epoch, "it followed a liar into another epoch");
                world.watch().expect(angle_between(now.attitude, truth(now.sequence)) <= gate_rad, "it followed a liar");
                expected = now.sequence + 1;
            };
            for (const Event& event : events) {
                world.play(event);
                if (!world.problem().empty()) break;
            }
            return world.problem();
        });
}

TEST(RandomEvents, never_expel_the_lane_that_isolated_first_and_rightly)
{
    hold(
        [](Random& random) {
            Events events(5 + random() % 10, {Happening::frame, 0, 0});
            events.push_back({Happening::sensor_fault, random() % 3, random()});
            events.insert(events.end(), 60 + random() % 60, {Happening::frame, 0, 0});
            for (Event& event : events) event.how = random();
            return events;
        },
        [](const Events& events) {
            World world({});
            std::size_t first = 0;
            std::uint64_t fault_at = never, spread_at = never;
            world.on_output = [&](std::size_t, const VotedAttitude& now) {
                const auto why = static_cast<LaneExclusion>(now.excluded_why[first]);
                world.watch().expect(why == LaneExclusion::none || why == LaneExclusion::uncorroborated, "the first one is expelled");
                world.watch().expect(
                    now.sequence <= spread_at || now.sequence < fault_at || angle_between(now.attitude, truth(now.sequence)) < 1e-6,
                    "the output is wrong although two detectors know better");
                world.watch().expect(now.vouching_mask != 0, "it coasts");
            };
            for (const Event& event : events) {
                if (event.what == Happening::sensor_fault) {
                    Random random(event.how);
                    fault_at = world.newest().sequence + 1;
                    world.play(event);
                    first = event.where;
                    std::uint64_t second_suspicion = never;
                    for (std::size_t index = 0; index < 3; ++index) {
                        Lane& lane = world.lanes()[index];
                        lane.suspect_in = static_cast<unsigned>(random() % 4);
                        if (index != first) lane.suspect_in += static_cast<unsigned>(4 + random() % 30);
                        lane.isolate_in = lane.suspect_in + static_cast<unsigned>(1 + random() % 4);
                        if (index != first) second_suspicion = std::min<std::uint64_t>(second_suspicion, lane.suspect_in);
                    }
                    // The second suspicion is voiced in this frame; its verdict may come after the frame's attitudes.
                    spread_at = fault_at + std::max<std::uint64_t>(second_suspicion, world.lane(first).isolate_in) + 1;
                } else {
                    world.play(event);
                }
                if (!world.problem().empty()) break;
            }
            return world.problem();
        });
}

TEST(RandomEvents, are_always_recovered_from_when_the_cause_ends)
{
    hold(
        [](Random& random) {
            return mixed(random, 40, 3,
                         {Happening::kill, Happening::kill, Happening::revive, Happening::lie, Happening::honest, Happening::sensor_fault,
                          Happening::readmit, Happening::pause, Happening::restart_publisher, Happening::stall});
        },
        [](const Events& events) {
            World world({.liars_may_lie_about_epochs = false});
            for (const Event& event : events) world.play(event);
            world.end_all_causes();
            for (std::uint32_t frame = 0; frame < 150; ++frame) world.play({Happening::frame, 0, frame});
            world.watch().expect(world.watch().last().has_value(), "nothing was ever published");
            if (!world.watch().last()) return world.problem();
            const VotedAttitude& last = *world.watch().last();
            world.watch().expect(identity_of(last) == world.newest(), "the output has stopped");
            world.watch().expect(level_of(last) == VoteLevel::full, "not FULL again");
            world.watch().expect(last.excluded_mask == 0, "a lane is still excluded");
            return world.problem();
        });
}

TEST(RandomEvents, of_two_voters_leave_no_frame_out_and_never_step_back)
{
    hold(
        [](Random& random) {
            Events events(40, {Happening::frame, 0, 0});
            for (int happening = 0; happening < 4; ++happening) {
                events.push_back(
                    {any_of(random, {Happening::kill_voter, Happening::stall, Happening::standstill, Happening::revive_voter, Happening::kill,
                                     Happening::revive}),
                     3 * (random() % 2), random()});  // lane a; either voter
                const std::size_t quiet = random() % 3 == 0 ? random() % 10 : 45;
                events.insert(events.end(), quiet, {Happening::frame, 0, 0});
            }
            for (Event& event : events) event.how = random();
            return events;
        },
        [](const Events& events) {
            World world({.jitter_us = 3000, .voters = 2});
            constexpr std::int64_t lease = 50 * ms;
            std::array<std::int64_t, 2> alive_ns{-lease, -lease};
            std::optional<VotedAttitude> read;
            std::uint64_t merged = 0;
            std::map<std::uint64_t, std::int64_t> owed;  // frames not published yet, and since when a later one has been
            world.on_output = [&](std::size_t voter, const VotedAttitude& now) {
                if (now.vouching_mask != 0) {
                    // One voter may be ahead while the other still waits for the late primary of an earlier frame.
                    for (; merged <= now.sequence; ++merged) owed.emplace(merged, world.now());
                    owed.erase(now.sequence);
                    const bool in_time = owed.empty() || world.now() - owed.begin()->second <= 2 * interval;
                    world.watch(voter).expect(in_time, "neither voter published a frame");
                }
                if (world.voter(voter).may_own()) alive_ns[voter] = world.now();
            };
            world.on_owned = [&](std::size_t voter, const VotedAttitude& now) {
                alive_ns[voter] = world.now();
                if (voter == 1 && world.now() - alive_ns[0] <= lease) return;  // the reader listens to the stronger one
                const bool repeated = now.vouching_mask == 0;
                const bool forward = !read || identity_of(now) > identity_of(*read) || (repeated && identity_of(now) == identity_of(*read));
                world.watch(voter).expect(forward, "the voted stream steps back, or repeats a frame");
                read = now;
            };
            for (const Event& event : events) {
                world.play(event);
                if (!world.problem().empty()) break;
            }
            return world.problem();
        });
}

TEST(RandomEvents, take_the_arrows_between_the_states_of_a_voter_that_are_drawn)
{
    std::set<StatesSeen::Arrow> taken;
    for (std::uint64_t seed = 1; seed <= 400; ++seed) {
        Random random(seed);
        World world({.voters = 2});
        for (const Event& event : mixed(random, 120, 8,
                                        {Happening::stall, Happening::stall, Happening::kill, Happening::revive, Happening::pause,
                                         Happening::kill_voter, Happening::revive_voter})) {
            world.play(event);
            for (std::size_t voter = 0; voter < 2; ++voter)
                taken.insert(world.states(voter).arrows().begin(), world.states(voter).arrows().end());
        }
        ASSERT_EQ(world.problem(), "") << "seed " << seed;
    }
    std::set<StatesSeen::Arrow> drawn = StatesSeen::drawn();
    EXPECT_EQ(drawn.erase({"cut_off", "listening"}), 1u) << "taken by TwoVoters.listen_when_they_are_delayed_while_cut_off";
    EXPECT_EQ(taken, drawn);
}
