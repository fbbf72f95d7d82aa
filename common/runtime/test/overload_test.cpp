// When a consumer leaves results out, and when it does not. In each case ages come from a stream of frames, as a consumer meets them.

#include "quorient/runtime/overload.hpp"

#include "state_diagram.hpp"

#include <gtest/gtest.h>
#include <algorithm>
#include <array>
#include <limits>
#include <set>
#include <string_view>

using namespace quorient;
using namespace quorient::runtime;

namespace {

using State = Overload::State;

constexpr std::int64_t ms = 1'000'000;
constexpr std::int64_t s = 1000 * ms;

std::string_view to_string(State state)
{
    constexpr std::array<std::string_view, 4> names{"keeping_up", "falling_behind", "shedding", "trying"};
    return names[static_cast<std::size_t>(state)];
}

/// A consumer that takes `work_ns` for a frame, a quarter of it while it sheds (of the frames that it leaves out it takes none). Frames wait
/// in a queue that holds 64.
class Consumer {
public:
    explicit Consumer(std::int64_t interval) : interval_ns(interval), overload(static_cast<double>(interval) * 1e-9) {}

    void work_for(std::int64_t span_ns, std::int64_t work_ns)
    {
        const std::int64_t end = now + span_ns;
        while (now < end) {
            const std::int64_t newest = now / interval_ns;
            next = std::max(next, newest - 63);
            if (next > newest) {
                now = next * interval_ns;
                continue;
            }
            const std::int64_t age = now - next * interval_ns;
            const auto before = overload.state();
            const auto after = overload.on_sample(age, next * interval_ns, now);
            if (before != after) arrows.emplace(to_string(before), to_string(after));
            const bool left_out = overload.sheds() && next % 4 != 0;
            if (left_out) ++skipped;
            else now += work_ns;
            if (!left_out) oldest = std::max(oldest, age);
            ++next;
        }
    }

    void stand_still(std::int64_t span_ns) { now += span_ns; }

    std::int64_t interval_ns;
    Overload overload;
    std::int64_t now = 0;
    std::int64_t next = 0;
    std::uint64_t skipped = 0;
    std::int64_t oldest = 0;  ///< age of what was given out
    std::set<test::Arrow> arrows;
};

constexpr std::int64_t quick = 100'000;  // a tenth of an interval at 1 kHz

/// And has left nothing out.
void expect_that_it_keeps_up(Consumer& consumer)
{
    consumer.work_for(10 * s, quick);
    EXPECT_EQ(consumer.skipped, 0U);
    EXPECT_EQ(consumer.overload.state(), State::keeping_up);
}

class AnOverload : public testing::TestWithParam<std::int64_t> {
protected:
    std::int64_t interval_ns() const { return GetParam(); }
};

TEST_P(AnOverload, is_no_standstill_of_a_fraction_of_a_second)
{
    Consumer consumer(interval_ns());
    for (int stop = 0; stop < 50; ++stop) {
        consumer.work_for(stop % 2 == 0 ? s : 100 * ms, quick);
        consumer.stand_still(300 * ms);
    }
    expect_that_it_keeps_up(consumer);
}

TEST_P(AnOverload, is_no_pair_of_standstills_with_old_samples_between_them)
{
    Consumer consumer(interval_ns());
    consumer.work_for(s, quick);
    for (int stop = 0; stop < 3; ++stop) {
        consumer.stand_still(300 * ms);
        consumer.work_for(3 * quick, quick);
    }
    expect_that_it_keeps_up(consumer);
}

TEST_P(AnOverload, is_no_slowness_of_a_fraction_of_a_second)
{
    Consumer consumer(interval_ns());
    consumer.work_for(s, quick);
    consumer.work_for(400 * ms, interval_ns() * 3 / 2);
    expect_that_it_keeps_up(consumer);
}

TEST_P(AnOverload, that_lasts_bounds_the_age_of_what_is_given_out)
{
    Consumer consumer(interval_ns());
    consumer.work_for(s, quick);
    consumer.work_for(4 * s, interval_ns() * 3 / 2);
    ASSERT_TRUE(consumer.overload.sheds());
    consumer.oldest = 0;
    consumer.work_for(s, interval_ns() * 3 / 2);
    EXPECT_LE(consumer.oldest, consumer.overload.bound_ns());
    EXPECT_GT(consumer.skipped, 0U);
}

TEST_P(AnOverload, that_is_over_leaves_nothing_out_any_more)
{
    Consumer consumer(interval_ns());
    consumer.work_for(s, quick);
    consumer.work_for(20 * s, interval_ns() * 3 / 2);
    consumer.work_for(60 * s, quick);
    EXPECT_EQ(consumer.overload.state(), State::keeping_up);
    const auto skipped = consumer.skipped;
    consumer.work_for(s, quick);
    EXPECT_EQ(consumer.skipped, skipped);
}

TEST_P(AnOverload, that_goes_on_is_tried_more_and_more_rarely)
{
    Consumer consumer(interval_ns());
    consumer.work_for(2 * s, interval_ns() * 3 / 2);
    std::int64_t shed_ns = 0;
    constexpr std::int64_t span = 600 * s;
    for (const std::int64_t end = consumer.now + span; consumer.now < end;) {
        const auto before = consumer.now;
        consumer.work_for(interval_ns(), interval_ns() * 3 / 2);
        if (consumer.overload.sheds()) shed_ns += consumer.now - before;
    }
    EXPECT_GT(static_cast<double>(shed_ns) / static_cast<double>(span), 0.98);
}

TEST_P(AnOverload, is_not_seen_in_constant_delays)
{
    SampleAge age;
    Overload overload(static_cast<double>(interval_ns()) * 1e-9);
    constexpr std::int64_t other_clock = 86400 * s;
    for (std::int64_t now = s; now < 100 * s; now += interval_ns()) overload.on_sample(age.see(1, now - 500 * ms + other_clock, now), now, now);
    EXPECT_EQ(overload.state(), State::keeping_up);
}

TEST_P(AnOverload, is_not_seen_in_a_publisher_with_another_clock)
{
    SampleAge age;
    Overload overload(static_cast<double>(interval_ns()) * 1e-9);
    for (std::int64_t now = s; now < 10 * s; now += interval_ns()) overload.on_sample(age.see(1, now, now), now, now);
    for (std::int64_t now = 10 * s; now < 20 * s; now += interval_ns()) overload.on_sample(age.see(2, now - 3600 * s, now), now, now);
    EXPECT_EQ(overload.state(), State::keeping_up);
}

TEST_P(AnOverload, is_not_seen_where_nothing_is_stamped)
{
    SampleAge age;
    for (std::int64_t now = s; now < 2 * s; now += interval_ns()) EXPECT_EQ(age.see(1, 0, now), 0);
}

TEST_P(AnOverload, changes_its_state_as_drawn)
{
    Consumer consumer(interval_ns());
    consumer.work_for(s, quick);
    consumer.work_for(100 * ms, interval_ns() * 3 / 2);
    consumer.stand_still(200 * ms);
    consumer.work_for(10 * s, quick);
    consumer.work_for(20 * s, interval_ns() * 3 / 2);
    consumer.work_for(60 * s, quick);
    EXPECT_EQ(consumer.arrows, test::state_diagram(QUORIENT_SOURCE_DIR "/common/runtime/README.md"));
}

INSTANTIATE_TEST_SUITE_P(At, AnOverload, testing::Values(5 * ms, ms), [](const auto& interval) { return interval.param == ms ? "1_kHz" : "200_Hz"; });

TEST(AnOverloadAtASlowRate, leaves_nothing_out_since_kept_frames_would_be_too_far_apart)
{
    Consumer consumer(10 * ms);
    consumer.work_for(s, quick);
    consumer.work_for(20 * s, 15 * ms);
    EXPECT_EQ(consumer.skipped, 0U);
    EXPECT_EQ(consumer.overload.on_others_shed(consumer.now), State::keeping_up);
}

TEST(SampleAge, is_0_where_a_stamp_cannot_be)
{
    SampleAge age;
    EXPECT_EQ(age.see(1, 1000 * ms, 1003 * ms), 0);
    EXPECT_EQ(age.see(1, std::numeric_limits<std::int64_t>::min(), 1008 * ms), 0);
    EXPECT_EQ(age.see(1, 1010 * ms, 1015 * ms), 2 * ms);
}

TEST(SampleAge, is_that_beyond_the_most_punctual_sample)
{
    SampleAge age;
    EXPECT_EQ(age.see(1, 1000 * ms, 1003 * ms), 0);
    EXPECT_EQ(age.see(1, 1005 * ms, 1020 * ms), 12 * ms);
    EXPECT_EQ(age.see(1, 1010 * ms, 1011 * ms), 0);
    EXPECT_EQ(age.see(1, 1015 * ms, 1020 * ms), 4 * ms);
}

TEST(SampleAge, forgets_a_clock_that_jumped_within_a_minute_or_so)
{
    SampleAge age;
    std::int64_t last = 0;
    for (std::int64_t now = s; now < 200 * s; now += ms) last = age.see(1, now < 50 * s ? now : now - 7 * s, now);
    EXPECT_EQ(last, 0);
}

}  // namespace
