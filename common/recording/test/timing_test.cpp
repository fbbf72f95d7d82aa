#include "quorient/recording/timing.hpp"

#include "time/stamp_guard.hpp"

#include <gmock/gmock.h>
#include <algorithm>
#include <cmath>
#include <random>

namespace quorient::recording {
namespace {

constexpr std::int64_t ms = 1'000'000;

InstrumentSample sample_at(std::int64_t time_ns, double x = 0.1, double covered_s = 0)
{
    InstrumentSample sample;
    sample.time_ns = time_ns;
    sample.covered_s = covered_s;
    sample.rate_rad_s = {x, 2 * x, 0.25 * std::sin(static_cast<double>(time_ns))};
    return sample;
}

TEST(InstrumentMeter, tells_period_and_jitter_of_stamps_rounded_to_milliseconds)
{
    InstrumentMeter meter;
    for (int i = 0; i < 2000; ++i) meter.add(sample_at(static_cast<std::int64_t>(std::floor(9.473 * i)) * ms));
    const InstrumentFigures figures = meter.figures();
    EXPECT_NEAR(figures.period_s, 9.473e-3, 5e-6);
    EXPECT_NEAR(figures.jitter_s, 0.5e-3, 0.1e-3) << "steps of 9 and 10 ms";
    EXPECT_EQ(figures.gaps, 0U);
    EXPECT_NEAR(figures.coverage, 1.0, 0.01);
    EXPECT_TRUE(meter.rate_changes().empty());
}

TEST(InstrumentMeter, counts_gaps_lost_samples_duplicates_and_steps_back)
{
    InstrumentMeter meter;
    std::int64_t time_ns = 0;
    for (int i = 0; i < 1000; ++i) {
        time_ns += 10 * ms;
        if (i == 600) time_ns += 30 * ms;      // three samples are missing
        if (i == 700) time_ns += 20'000 * ms;  // and 2000
        meter.add(sample_at(time_ns));
        if (i == 800) meter.add(sample_at(time_ns));
        if (i == 900) meter.add(sample_at(time_ns - 1000 * ms));
    }
    const InstrumentFigures figures = meter.figures();
    EXPECT_EQ(figures.gaps, 2U);
    EXPECT_EQ(figures.lost, 3U + 2000U);
    EXPECT_EQ(figures.duplicates, 1U);
    EXPECT_EQ(figures.steps_back, 1U);
    EXPECT_NEAR(figures.longest_gap_s, 20.01, 1e-9);
    EXPECT_NEAR(figures.coverage, 1.0, 0.01) << "in the hole of 20 s the logger paused";
}

TEST(InstrumentMeter, counts_no_gap_of_years_where_stamps_leave_for_another_epoch_and_return)
{
    for (const std::int64_t away_ms : {-1'000'000'000'000LL, 1'000'000'000'000LL, -1000LL}) {
        SCOPED_TRACE(away_ms);
        InstrumentMeter meter;
        for (int i = 0; i < 3000; ++i) {
            const bool away = i >= 1000 && i < 1200;
            meter.add(sample_at((1'000'000 + 10 * i + (away ? away_ms : 0)) * ms));
        }
        const InstrumentFigures figures = meter.figures();
        EXPECT_EQ(figures.steps_back, 1U);
        EXPECT_NEAR(figures.duration_s(), 29.99, 1e-6);
        EXPECT_LE(figures.longest_gap_s, 2.02) << "the time that was spent away";
        EXPECT_LE(figures.lost, 200U);
        EXPECT_GT(figures.coverage, 0.9);
    }
}

TEST(InstrumentMeter, covers_what_increments_cover_and_never_the_time_between)
{
    InstrumentMeter meter;
    for (int i = 0; i < 50; ++i) meter.add(sample_at(500 * ms * i, 0.1 * i, 0.005));
    EXPECT_NEAR(meter.figures().coverage, 0.01, 0.001);
    InstrumentMeter slow;
    for (int i = 0; i < 50; ++i) slow.add(sample_at(1000 * ms * i));
    EXPECT_NEAR(slow.figures().coverage, 0.1, 0.01) << "a rate at one instant stands for no second";
}

TEST(InstrumentMeter, tells_repeated_values_and_values_at_the_end_of_the_range)
{
    InstrumentMeter meter;
    for (int i = 0; i < 1000; ++i) {
        double x = 0.01 * (i % 7);
        if (i >= 300 && i < 330) x = 0.5;                    // stuck
        if (i >= 500 && i < 540) x = i % 2 == 0 ? 35.0 : -35.0;  // saturated
        auto sample = sample_at(10 * ms * i, x);
        if (i >= 500 && i < 540) sample.clipped = 0b001;
        meter.add(sample);
    }
    const InstrumentFigures figures = meter.figures();
    EXPECT_EQ(figures.repeated[0], 29U);
    EXPECT_NEAR(figures.longest_repeat_s[0], 0.29, 1e-9);
    EXPECT_EQ(figures.repeated[2], 0U);
    EXPECT_EQ(figures.at_extreme[0], 40U);
    EXPECT_EQ(figures.clipped[0], 40U);
    EXPECT_TRUE(figures.clipping_logged);
}

/// What x makes of a motion of 300 deg/s, and of noise, where the sensor ends at a range.
InstrumentFigures figures_at(double range_rad_s, double (*x_at)(int))
{
    InstrumentMeter meter;
    for (int i = 0; i < 6000; ++i) meter.add(sample_at(5 * ms * i, std::clamp(x_at(i), -range_rad_s, range_rad_s)));
    return meter.figures();
}

double turning(int i)
{
    return 5.2 * std::sin(0.01 * i) + 0.01 * std::sin(1.7 * i);
}

TEST(InstrumentMeter, knows_the_range_of_an_axis_that_stayed_at_it_again_and_again)
{
    const InstrumentFigures clipped = figures_at(4.36, turning);
    ASSERT_TRUE(clipped.range_reached[0]);
    EXPECT_EQ(clipped.range_reached[0]->range_rad_s, 4.36);
    double beyond = 0;
    for (int i = 0; i < 6000; ++i) beyond += std::abs(turning(i)) >= 4.36;
    EXPECT_NEAR(static_cast<double>(clipped.range_reached[0]->samples), beyond, 2);
    EXPECT_NEAR(static_cast<double>(clipped.range_reached[0]->first_ns) * 1e-9, 0.5, 0.01) << "5.2 sin(0.01 i) passes 4.36 after 99 samples";
    EXPECT_FALSE(clipped.range_reached[2]) << "a quarter of a radian a second";
}

TEST(InstrumentMeter, takes_motion_stuck_axes_and_spikes_for_no_range)
{
    EXPECT_FALSE(figures_at(35, turning).range_reached[0]);
    EXPECT_FALSE(figures_at(5.2, turning).range_reached[0]) << "the top of the motion";
    EXPECT_FALSE(figures_at(35, [](int i) { return i < 3000 ? turning(i) : 8.0; }).range_reached[0]) << "stuck";
    EXPECT_FALSE(figures_at(35, [](int i) { return i % 200 == 0 ? -40.0 : turning(i); }).range_reached[0]) << "spikes";
    EXPECT_FALSE(figures_at(35, [](int i) { return std::round(4 * std::sin(0.01 * i)) / 4; }).range_reached[0]) << "coarse steps at small rates";
}

TEST(InstrumentMeter, says_when_the_rate_changes)
{
    InstrumentMeter meter;
    std::int64_t time_ns = 0;
    for (int i = 0; i < 3000; ++i) {
        time_ns += (i < 1000 ? 10 : 20) * ms;
        meter.add(sample_at(time_ns));
    }
    const auto changes = meter.rate_changes();
    ASSERT_EQ(changes.size(), 1U);
    EXPECT_NEAR(changes[0].rate_hz, 50, 1);
    EXPECT_NEAR(changes[0].from_s, 10, 2);
}

std::vector<std::int64_t> guarded(const std::vector<std::int64_t>& stamps_ns, std::uint64_t* dropped = nullptr)
{
    StampGuard guard(0.01);
    std::vector<InstrumentSample> good;
    for (const std::int64_t stamp_ns : stamps_ns) guard.add(sample_at(stamp_ns), good);
    guard.finish(good);
    std::vector<std::int64_t> times;
    for (const InstrumentSample& sample : good) times.push_back(sample.time_ns);
    if (dropped != nullptr) *dropped = guard.dropped();
    return times;
}

std::vector<std::int64_t> regular(std::int64_t begin_ms, int count)
{
    std::vector<std::int64_t> stamps;
    for (int i = 0; i < count; ++i) stamps.push_back((begin_ms + 10 * i) * ms);
    return stamps;
}

std::vector<std::int64_t> joined(std::initializer_list<std::vector<std::int64_t>> parts)
{
    std::vector<std::int64_t> all;
    for (const auto& part : parts) all.insert(all.end(), part.begin(), part.end());
    return all;
}

TEST(StampGuard, passes_a_regular_clock_and_its_holes)
{
    const auto whole = joined({regular(1000, 500), regular(700'000, 500)});
    EXPECT_EQ(guarded(whole), whole);
    const auto short_end = joined({regular(1000, 500), regular(700'000, 20)});
    EXPECT_EQ(guarded(short_end), short_end) << "a log may end soon behind a hole";
}

TEST(StampGuard, drops_what_falls_to_another_epoch_and_returns)
{
    std::uint64_t dropped = 0;
    for (const std::int64_t other_ms : {-1'000'000'000LL, 4000LL, 2'000'000'000LL}) {
        const auto good = guarded(joined({regular(10'000, 300), regular(other_ms, 200), regular(15'000, 300)}), &dropped);
        EXPECT_EQ(good, joined({regular(10'000, 300), regular(15'000, 300)})) << other_ms;
        EXPECT_EQ(dropped, 200U);
    }
}

TEST(StampGuard, drops_what_steps_back_by_a_second_and_returns)
{
    std::uint64_t dropped = 0;
    const auto good = guarded(joined({regular(10'000, 300), regular(12'000, 200), regular(15'000, 300)}), &dropped);
    EXPECT_EQ(good, joined({regular(10'000, 300), regular(15'000, 300)})) << "the second line passes the end of the first, and is none of it";
    EXPECT_EQ(dropped, 200U);
}

TEST(StampGuard, drops_one_sample_that_is_out_of_order_and_no_more)
{
    std::uint64_t dropped = 0;
    EXPECT_EQ(guarded(joined({regular(10'000, 300), {12'985 * ms}, regular(13'000, 800)}), &dropped),
              joined({regular(10'000, 300), regular(13'000, 800)}));
    EXPECT_EQ(dropped, 1U);
}

TEST(StampGuard, goes_on_behind_the_last_good_stamp_where_a_clock_was_set_back)
{
    const auto good = guarded(joined({regular(100'000, 300), regular(50'000, 1000)}));
    ASSERT_EQ(good.size(), 1300U);
    EXPECT_EQ(good[300], good[299] + 10 * ms);
    EXPECT_EQ(good[1299], good[299] + 1000 * 10 * ms);
}

TEST(StampGuard, counts_a_repeated_stamp_once)
{
    std::uint64_t dropped = 0;
    EXPECT_EQ(guarded({10 * ms, 20 * ms, 20 * ms, 30 * ms}, &dropped), (std::vector<std::int64_t>{10 * ms, 20 * ms, 30 * ms}));
    EXPECT_EQ(dropped, 1U);
}

}  // namespace
}  // namespace quorient::recording
