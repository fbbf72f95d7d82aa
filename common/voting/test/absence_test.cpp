// A voter that did not run for a while: it gives out late what nobody else has given out, and nothing else.

#include "scene.hpp"

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
        VotedAttitude output;
        output.epoch = first_epoch;
        output.sequence = sequence;
        output.output_sequence = sequence + 1;
        output.attitude = truth(sequence);
        output.unit = 7;
        output.voter = 1;
        output.primary_lane = 1;
        output.vouching_mask = 7;
        scene.at(time, output);
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
            for (std::uint64_t sequence = lost_from + published; sequence + 5 < end; ++sequence) EXPECT_TRUE(given_out.contains(sequence)) << sequence;
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

}  // namespace
