// A voter that did not run for a while: it gives out late what no other voter has given out, and nothing else.

#include "pair_of_voters.hpp"

#include <gtest/gtest.h>
#include <algorithm>
#include <set>

using namespace quorient;
using namespace quorient::voting;
using namespace quorient::voting::test;

namespace {

constexpr std::uint64_t lost_from = 100;  ///< the first frame that arrives while the voter does not run
constexpr std::uint64_t end = 400;
constexpr std::uint64_t queue = 64;  ///< samples that a reader of the lanes' attitudes keeps

/// The weaker of two voters; the stronger one is its script.
struct Weaker {
    explicit Weaker(std::int64_t frame_interval) : interval_ns(frame_interval), scene(settings(frame_interval)) {}

    static VoterSettings settings(std::int64_t frame_interval)
    {
        auto settings = settings_of(3, {1, 2}, 2);
        settings.interval_s = static_cast<double>(frame_interval) * 1e-9;
        return settings;
    }

    std::int64_t time_of(std::uint64_t sequence) const { return static_cast<std::int64_t>(sequence + 1) * interval_ns; }

    void lanes_deliver(std::uint64_t sequence, std::int64_t time)
    {
        for (std::size_t lane = 0; lane < 3; ++lane) scene.at(time, sample_of(lane, sequence));
    }

    void stronger_publishes(std::uint64_t sequence, std::int64_t time)
    {
        scene.at(time, output_by(1, sequence, sequence + 1));
    }

    /// @param away       frames that arrive while this voter does not run
    /// @param published  of those, the stronger voter publishes so many before it dies
    void run(std::uint64_t away, std::uint64_t published)
    {
        for (std::uint64_t sequence = 0; sequence < lost_from; ++sequence) {
            stronger_publishes(sequence, time_of(sequence));
            lanes_deliver(sequence, time_of(sequence));
        }
        const auto wakes = time_of(lost_from + away - 1) + interval_ns / 2;
        scene.stopped_until(wakes);
        for (std::uint64_t i = 0; i < away; ++i) lanes_deliver(lost_from + i, wakes);
        for (std::uint64_t i = 0; i < published; ++i) stronger_publishes(lost_from + i, wakes);
        for (std::uint64_t sequence = lost_from + away; sequence < end; ++sequence) lanes_deliver(sequence, time_of(sequence));
    }

    std::set<std::uint64_t> given_out() const
    {
        std::set<std::uint64_t> sequences;
        for (const auto& output : scene.outputs) sequences.insert(output.sequence);
        return sequences;
    }

    std::int64_t interval_ns;
    Scene scene;
};

class Absence : public testing::TestWithParam<std::int64_t> {};

TEST_P(Absence, costs_time_and_no_frame)
{
    for (std::uint64_t away = 4; away <= queue; away += 6) {
        for (const std::uint64_t published : {0, 1, 3}) {
            SCOPED_TRACE(testing::Message() << away << " frames away, " << published << " of them published by the other");
            Weaker weaker(GetParam());
            weaker.run(away, published);
            const auto given_out = weaker.given_out();
            for (std::uint64_t sequence = lost_from + published; sequence + 5 < end; ++sequence)
                EXPECT_TRUE(given_out.contains(sequence)) << sequence;
            EXPECT_EQ(weaker.scene.voter.counters().gaps, 0U);
        }
    }
}

TEST_P(Absence, repeats_nothing_that_the_other_has_given_out)
{
    constexpr std::uint64_t away = queue;
    Weaker weaker(GetParam());
    weaker.run(away, away);
    const auto given_out = weaker.given_out();
    for (std::uint64_t sequence = lost_from; sequence < lost_from + away; ++sequence) EXPECT_FALSE(given_out.contains(sequence)) << sequence;
    EXPECT_TRUE(given_out.contains(end - 10));
}

TEST_P(Absence, leaves_voted_going_forward)
{
    constexpr std::uint64_t away = queue;
    Weaker weaker(GetParam());
    weaker.run(away, 0);
    const auto& owned = weaker.scene.owned;
    ASSERT_FALSE(owned.empty());
    EXPECT_EQ(owned.back().sequence, end - 1);
    EXPECT_TRUE(std::ranges::is_sorted(owned, std::ranges::less_equal{}, &VotedAttitude::sequence)) << "each frame once, none older than the last";
}

INSTANTIATE_TEST_SUITE_P(At, Absence, testing::Values(5 * ms, ms), [](const auto& interval) { return interval.param == ms ? "1_kHz" : "200_Hz"; });

/// The stronger of two voters returns after two seconds in which the weaker one took over. When it begins to write, the weaker one may just
/// have ceased to wait for it, and have written the same frame.
struct Stronger {
    static constexpr std::uint64_t back_from = lost_from + 400;

    /// @param late_from   from this frame on the lanes' samples of six frames come late, in time for the next frame
    /// @param weaker_lives  it goes on after this one's return
    /// @returns the first frame that this voter writes after its return
    std::uint64_t first_written(std::uint64_t late_from, bool weaker_lives)
    {
        for (std::uint64_t sequence = 0; sequence < lost_from; ++sequence) frame(sequence, 0, true);
        scene.stopped_until(Scene::time_of(back_from) - ms);
        scene.at(scene.now, output_by(2, lost_from + 10, lost_from + 11));  // it took over
        for (std::uint64_t waiting = back_from - 40; waiting < back_from; ++waiting) {  // in its queues; the other's outputs are on their way still
            for (std::size_t lane = 0; lane < 3; ++lane) scene.at(scene.now, sample_of(lane, waiting));
        }
        for (std::uint64_t sequence = back_from; sequence < back_from + 100; ++sequence) {
            const bool late = sequence >= late_from && sequence < late_from + 6;
            frame(sequence, late ? 4 * ms : 0, weaker_lives);
        }
        const auto first = std::ranges::find_if(scene.owned, [](const VotedAttitude& output) { return output.sequence >= lost_from; });
        return first == scene.owned.end() ? 0 : first->sequence;
    }

    void frame(std::uint64_t sequence, std::int64_t late_ns, bool weaker_publishes)
    {
        const std::int64_t time = Scene::time_of(sequence) + late_ns;
        for (std::size_t lane = 0; lane < 3; ++lane) scene.at(time, sample_of(lane, sequence));
        if (!weaker_publishes) return;
        scene.at(time + ms / 2, output_by(2, sequence, sequence + 1));
    }

    Scene scene{settings_of(3, {1, 2}, 1)};
};

TEST(ReturnOfTheStronger, begins_with_no_frame_that_the_weaker_may_have_ceased_to_wait_for)
{
    const std::uint64_t punctual = Stronger().first_written(0, true);
    ASSERT_GT(punctual, Stronger::back_from);
    EXPECT_EQ(Stronger().first_written(punctual - 1, true), punctual + 5) << "the first punctual frame";
    EXPECT_EQ(Stronger().first_written(punctual + 1, true), punctual) << "once it writes, a late frame is written all the same";
}

TEST(ReturnOfTheStronger, gives_the_weaker_time_to_find_it_before_it_writes)
{
    constexpr std::uint64_t lease_frames = 10;
    constexpr std::uint64_t good_frames = 20;
    EXPECT_GE(Stronger().first_written(0, true), Stronger::back_from + lease_frames + good_frames - 1);
}

TEST(ReturnOfTheStronger, waits_for_no_weaker_voter_that_is_dead)
{
    const std::uint64_t punctual = Stronger().first_written(0, false);
    ASSERT_GT(punctual, Stronger::back_from);
    const std::uint64_t late = Stronger().first_written(punctual - 1, false);
    EXPECT_GT(late, Stronger::back_from);
    EXPECT_LE(late, punctual);
}

/// The stronger of two voters is stopped between its decision about a frame and the write, as a signal may stop a process anywhere.
/// @returns whether that frame is written when it goes on
bool is_written_after(std::int64_t pause_ns)
{
    Scene scene(settings_of(3, {1, 2}, 1));
    scene.frames(0, lost_from - 1);
    for (std::size_t lane = 0; lane < 3; ++lane) scene.voter.on_attitude(sample_of(lane, lost_from), Scene::time_of(lost_from));
    scene.now = Scene::time_of(lost_from) + pause_ns;
    scene.collect();
    EXPECT_TRUE(std::ranges::any_of(scene.outputs, [](const VotedAttitude& output) { return output.sequence == lost_from; }));
    return scene.owned.back().sequence == lost_from;
}

TEST(StopBeforeAWrite, leaves_the_frame_to_the_voter_that_took_over)
{
    EXPECT_FALSE(is_written_after(2000 * ms));
    EXPECT_FALSE(is_written_after(60 * ms));
}

TEST(StopBeforeAWrite, too_short_for_another_voter_to_take_over_keeps_no_frame_back)
{
    EXPECT_TRUE(is_written_after(0));
    EXPECT_TRUE(is_written_after(20 * ms));
}

/// The whole machine stands still for a while: the lanes' samples wait in the queues of both voters.
struct StandStill {
    /// @param weaker_later_ns  the weaker voter goes on so much later than the stronger one
    StandStill(std::int64_t still_ns, std::int64_t weaker_later_ns)
    {
        pair.frames(0, lost_from - 1);
        const std::int64_t wakes = Scene::time_of(lost_from) - ms + still_ns;
        pair.strong.stopped_until(wakes);
        const std::uint64_t before = deliver(pair.strong, lost_from, wakes);
        pair.weak.stopped_until(wakes + weaker_later_ns);
        const std::uint64_t next = deliver(pair.weak, lost_from, pair.weak.now);
        deliver(pair.strong, before, pair.weak.now);
        pair.frames(next, end);
    }

    /// The frames up to this time that are due by then, at once. @returns the next frame.
    static std::uint64_t deliver(Scene& scene, std::uint64_t sequence, std::int64_t time)
    {
        for (; Scene::time_of(sequence) <= time; ++sequence) {
            for (std::size_t lane = 0; lane < 3; ++lane) scene.at(time, sample_of(lane, sequence));
        }
        return sequence;
    }

    Pair pair;
};

TEST(StandStillOfTheMachine, leaves_no_frame_of_voted_out)
{
    for (const std::int64_t still_ns : {42 * ms, 60 * ms, 200 * ms}) {
        for (const std::int64_t weaker_later_ns : {0 * ms, 1 * ms, 4 * ms}) {
            SCOPED_TRACE(testing::Message() << still_ns / ms << " ms still, the weaker one " << weaker_later_ns / ms << " ms later");
            StandStill scene(still_ns, weaker_later_ns);
            ASSERT_GT(scene.pair.strong.voter.counters().absences, 0U);
            std::uint64_t expected = 20;  // good frames before owning
            for (const VotedAttitude& output : scene.pair.strong.owned) EXPECT_EQ(output.sequence, expected++);
            EXPECT_GE(expected, end);
            EXPECT_EQ(scene.pair.strong.count(EventCode::ownership_taken), 1U) << "nothing has changed for an operator";
            const auto& weak = scene.pair.weak.owned;
            const auto wrote = [](const VotedAttitude& output) { return output.sequence >= lost_from && output.sequence < lost_from + 40; };
            EXPECT_TRUE(std::ranges::none_of(weak, wrote)) << "a reader that lost the stronger one would receive frames twice";
        }
    }
}

std::uint64_t first_written(const Scene& scene)
{
    const auto found =
        std::ranges::find_if(scene.owned, [](const VotedAttitude& output) { return output.sequence >= lost_from && output.vouching_mask != 0; });
    return found == scene.owned.end() ? 0 : found->sequence;
}

/// The weaker voter runs all the time and has had nothing to publish: it takes the first frame that comes.
TEST(StandStillOfTheMachine, gives_the_owner_its_right_back_only_where_frames_waited_that_nobody_published)
{
    const std::int64_t last = Scene::time_of(lost_from - 1);
    const std::int64_t listens_until = last + 110 * ms;  // it goes on after 60 ms, and listens for a lease of 50 ms
    for (const std::uint64_t first : {lost_from + 26, lost_from + 20}) {
        SCOPED_TRACE(testing::Message() << "frames come again " << (Scene::time_of(first) - listens_until) / ms
                                        << " ms after the owner has listened");
        Pair pair;
        pair.frames(0, lost_from - 1);
        pair.strong.stopped_until(last + 60 * ms);
        pair.frames(first, end);
        EXPECT_EQ(first_written(pair.weak), first);
        EXPECT_GT(first_written(pair.strong), first + 15);
    }
}

/// The owner is stopped between its decision about a frame and the write; the frames of the stop wait in its queues.
/// @param other_until  the weaker voter publishes up to this frame before it stops too
std::vector<std::uint64_t> written_after_a_stop_before_the_write(std::uint64_t other_until)
{
    Scene scene(settings_of(3, {1, 2}, 1));
    scene.frames(0, lost_from - 1);
    for (std::size_t lane = 0; lane < 3; ++lane) scene.voter.on_attitude(sample_of(lane, lost_from), Scene::time_of(lost_from));
    const std::uint64_t next = lost_from + 13;
    scene.stopped_until(Scene::time_of(next) - ms);
    for (std::uint64_t sequence = lost_from; sequence <= other_until; ++sequence) scene.at(scene.now, output_by(2, sequence, sequence + 1));
    for (std::uint64_t sequence = lost_from + 1; sequence < next; ++sequence) {
        for (std::size_t lane = 0; lane < 3; ++lane) scene.at(scene.now, sample_of(lane, sequence));
    }
    scene.frames(next, end);
    std::vector<std::uint64_t> written;
    for (const VotedAttitude& output : scene.owned) {
        if (output.sequence >= lost_from) written.push_back(output.sequence);
    }
    return written;
}

TEST(StandStillOfTheMachine, lets_the_owner_write_what_it_had_decided_to_unless_the_weaker_one_may_have)
{
    const auto alone = written_after_a_stop_before_the_write(lost_from - 1);
    ASSERT_FALSE(alone.empty());
    EXPECT_EQ(alone.front(), lost_from);
    const auto after = written_after_a_stop_before_the_write(lost_from + 1);
    ASSERT_FALSE(after.empty());
    EXPECT_EQ(after.front(), lost_from + 2) << "the first frame that no voter has published";
    EXPECT_LT(after.front(), lost_from + 13) << "it resumes";
}

TEST(StandStillOfTheMachine, costs_an_only_voter_no_frame_that_comes_after_it)
{
    constexpr std::uint64_t first = lost_from + 16;
    Scene scene(settings_of(3));
    scene.frames(0, lost_from - 1);
    scene.stopped_until(Scene::time_of(first) - 2 * ms);
    scene.frames(first, end);
    EXPECT_EQ(first_written(scene), first);
}

}  // namespace
