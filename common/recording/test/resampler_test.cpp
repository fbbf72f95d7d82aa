#include "quorient/recording/resampler.hpp"

#include <gtest/gtest.h>
#include <cmath>

namespace quorient::recording {
namespace {

constexpr std::int64_t ms = 1'000'000;

InstrumentSample sample_of(std::array<double, 3> rate, double covered_s = 0)
{
    InstrumentSample sample;
    sample.rate_rad_s = rate;
    sample.covered_s = covered_s;
    return sample;
}

/// Angle about x at a time, and the mean rate between two.
double angle(double t)
{
    return 0.8 * std::sin(3.1 * t) + 0.2 * std::sin(17 * t);
}

/// One instrument that integrates without loss between its own sample times.
struct Source {
    double period_s = 0.01;
    double begin_s = 0;
    std::vector<std::pair<double, double>> silent{};  // from, to
    double end_s = 10;
};

std::vector<AlignedFrame> aligned(const std::vector<Source>& sources, std::size_t leader = 0, std::size_t per_frame = 1)
{
    ResampleSettings settings;
    settings.leader = leader;
    settings.samples_per_frame = per_frame;
    for (const Source& source : sources) settings.period_s.push_back(source.period_s);
    Resampler resampler(settings);
    std::vector<AlignedFrame> frames;
    AlignedFrame frame;
    std::vector<double> next_s;
    for (const Source& source : sources) next_s.push_back(source.begin_s + source.period_s);
    for (;;) {
        const auto soonest = static_cast<std::size_t>(std::min_element(next_s.begin(), next_s.end()) - next_s.begin());
        const Source& source = sources[soonest];
        const double t = next_s[soonest];
        if (t > 1e6) break;
        next_s[soonest] = t + source.period_s > source.end_s ? 1e9 : t + source.period_s;
        const bool silent =
            std::any_of(source.silent.begin(), source.silent.end(), [&](const auto& spell) { return t > spell.first && t < spell.second; });
        if (silent) continue;
        const double rate = (angle(t) - angle(t - source.period_s)) / source.period_s;
        resampler.add(soonest, std::llround(t * 1e9), sample_of({rate, 1.0, static_cast<double>(soonest)}));
        while (resampler.next(frame)) frames.push_back(frame);
    }
    resampler.finish();
    while (resampler.next(frame)) frames.push_back(frame);
    return frames;
}

bool has(const AlignedFrame& frame, std::size_t instrument)
{
    return has_axis(frame.valid_mask, 3 * instrument);
}

TEST(Resampler, gives_rows_of_equal_times_as_they_are)
{
    const auto frames = aligned({{}, {}, {}});
    ASSERT_EQ(frames.size(), 1000U);
    for (std::size_t i = 0; i < frames.size(); ++i) {
        const double t = 0.01 * static_cast<double>(i + 1);
        EXPECT_EQ(frames[i].time_ns, std::llround(t * 1e9));
        EXPECT_EQ(frames[i].valid_mask, 0b111'111'111U);
        EXPECT_EQ(frames[i].rate_rad_s[0], frames[i].rate_rad_s[0]);
        EXPECT_EQ(frames[i].rate_rad_s[2][0], frames[i].rate_rad_s[0][0]) << "bit for bit";
        EXPECT_EQ(frames[i].rate_rad_s[1][1], 1.0);
        EXPECT_EQ(frames[i].after_gap, i == 0);
    }
}

TEST(Resampler, loses_no_rotation_of_instruments_with_times_of_their_own)
{
    const auto frames = aligned({{1 / 751.0, 0}, {1 / 772.0, 0.0007}, {1 / 795.0, 0.0011}}, 0, 3);
    ASSERT_GT(frames.size(), 2490U);
    double turned[3] = {};
    const double begin_s = static_cast<double>(frames[10].time_ns) * 1e-9 - frames[10].interval_s;
    for (std::size_t i = 10; i < frames.size() - 10; ++i) {
        ASSERT_EQ(frames[i].valid_mask, 0b111'111'111U) << i;
        const double end_s = static_cast<double>(frames[i].time_ns) * 1e-9;
        for (std::size_t k = 0; k < 3; ++k) {
            turned[k] += frames[i].rate_rad_s[k][0] * frames[i].interval_s;
            // Splitting an interval at a constant rate is off by the change of rate within it, 70 rad/s^2 times 1.3 ms squared / 8.
            ASSERT_NEAR(turned[k], angle(end_s) - angle(begin_s), 6e-5) << "instrument " << k << " at " << end_s;
        }
    }
}

TEST(Resampler, loses_of_an_instrument_that_misses_samples_their_intervals_alone)
{
    const auto frames = aligned({{}, {0.01, 0, {{2.005, 2.015}, {4.0049, 4.052}}}, {}});
    ASSERT_EQ(frames.size(), 1000U);
    std::size_t missing = 0;
    for (const AlignedFrame& frame : frames) {
        EXPECT_TRUE(has(frame, 0) && has(frame, 2));
        missing += has(frame, 1) ? 0 : 1;
        if (has(frame, 1)) {
            EXPECT_EQ(frame.rate_rad_s[1][0], frame.rate_rad_s[0][0]) << "paired by time";
        }
    }
    EXPECT_EQ(missing, 1U + 5U);
}

TEST(Resampler, goes_on_at_its_pace_where_the_leader_misses_samples_or_ends)
{
    const auto frames = aligned({{0.01, 0, {{2.005, 2.045}}, 6}, {}, {}});
    ASSERT_NEAR(static_cast<double>(frames.size()), 1000, 1);
    std::size_t missing = 0;
    for (const AlignedFrame& frame : frames) {
        EXPECT_NEAR(frame.interval_s, 0.01, 1e-4);
        EXPECT_TRUE(has(frame, 1) && has(frame, 2));
        missing += has(frame, 0) ? 0 : 1;
    }
    EXPECT_NEAR(static_cast<double>(missing), 4 + 400, 1);
}

TEST(Resampler, does_not_wait_for_a_leader_that_begins_late)
{
    for (const double begin_s : {2.0, 20.0}) {
        SCOPED_TRACE(begin_s);
        const auto frames = aligned({{0.01, begin_s, {}, 30}, {0.01, 0, {}, 30}, {0.01, 0, {}, 30}});
        ASSERT_NEAR(static_cast<double>(frames.size()), 3000, 1);
        std::size_t missing = 0;
        for (const AlignedFrame& frame : frames) {
            EXPECT_NEAR(frame.interval_s, 0.01, 1e-4);
            EXPECT_TRUE(has(frame, 1) && has(frame, 2));
            missing += has(frame, 0) ? 0 : 1;
        }
        EXPECT_NEAR(static_cast<double>(missing), 100 * begin_s, 1);
    }
}

TEST(Resampler, steps_over_a_hole_in_all_of_them)
{
    const std::vector<std::pair<double, double>> hole{{3.0001, 631.0}};
    const auto frames = aligned({{0.01, 0, hole, 640}, {0.01, 0, hole, 640}});
    std::size_t gaps = 0;
    for (std::size_t i = 1; i < frames.size(); ++i) {
        EXPECT_NEAR(frames[i].interval_s, 0.01, 1e-4);
        const double step_s = static_cast<double>(frames[i].time_ns - frames[i - 1].time_ns) * 1e-9;
        EXPECT_EQ(frames[i].after_gap, step_s > 0.02) << i;
        gaps += frames[i].after_gap ? 1 : 0;
    }
    EXPECT_EQ(gaps, 1U);
    EXPECT_NEAR(static_cast<double>(frames.size()), 300 + 900, 3);
}

TEST(Resampler, calls_nothing_covered_that_increments_do_not_cover)
{
    Resampler resampler({{0.01, 0.5}, 0, 1, 2.0});
    std::size_t valid = 0, frames = 0;
    AlignedFrame frame;
    for (int i = 1; i <= 1000; ++i) {
        resampler.add(0, 10 * ms * i, sample_of({1, 1, 1}));
        if (i % 50 == 0) resampler.add(1, 10 * ms * i, sample_of({2, 2, 2}, 0.005));
        while (resampler.next(frame)) {
            ++frames;
            valid += has(frame, 1) ? 1 : 0;
        }
    }
    EXPECT_GT(frames, 700U);
    EXPECT_EQ(valid, 0U) << "5 ms are half of a frame";
}

TEST(Resampler, keeps_axes_apart_and_says_which_are_clipped)
{
    Resampler resampler({{0.01}, 0, 1, 2.0});
    auto sample = sample_of({1, std::nan(""), 3});
    sample.clipped = 0b100;
    resampler.add(0, 10 * ms, sample);
    resampler.add(0, 10 * ms, sample_of({9, 9, 9}));
    resampler.finish();
    AlignedFrame frame;
    ASSERT_TRUE(resampler.next(frame));
    EXPECT_EQ(frame.valid_mask, 0b101U);
    EXPECT_EQ(frame.clipped_mask, 0b100U);
    EXPECT_EQ(frame.rate_rad_s[0][0], 1.0);
    EXPECT_EQ(resampler.out_of_order(), 1U);
    EXPECT_FALSE(resampler.next(frame));
}

}  // namespace
}  // namespace quorient::recording
