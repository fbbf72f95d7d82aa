#include "quorient/calibration/rest.hpp"

#include "synthetic.hpp"

#include <gtest/gtest.h>

namespace quorient::calibration {
namespace {

/// One axis, 100 Hz, with white noise about a mean that is a function of time.
template <class Mean>
std::vector<Sample> one_axis(double duration_s, double sigma, Mean mean)
{
    std::mt19937_64 random(5);
    std::normal_distribution<double> normal;
    std::vector<Sample> samples;
    for (std::size_t i = 1; static_cast<double>(i) * interval_s <= duration_s; ++i) {
        const double t = static_cast<double>(i) * interval_s;
        Sample sample{t, interval_s, geometry::AxisVector(1), true, true};
        sample.rate(0) = mean(t) + sigma * normal(random);
        samples.push_back(sample);
    }
    return samples;
}

TEST(RestingSegments, are_found_between_motions)
{
    std::mt19937_64 random(1);
    const auto samples = record(three_triads(random), 150, random);
    const auto segments = resting_segments(samples);
    ASSERT_EQ(segments.size(), 3U);
    for (std::size_t i = 0; i < 3; ++i) {
        const double begin_s = samples[segments[i].begin].time_s - 60.0 * static_cast<double>(i);
        const double end_s = samples[segments[i].end - 1].time_s - 60.0 * static_cast<double>(i);
        EXPECT_GE(begin_s, 0);
        EXPECT_LE(begin_s, 1.6);
        EXPECT_LE(end_s, 20.0);
        EXPECT_GE(end_s, 18.4);
    }
}

TEST(RestingSegments, are_not_found_in_motion)
{
    EXPECT_TRUE(resting_segments(one_axis(60, 1e-3, [](double t) { return std::sin(5 * t); })).empty());
    EXPECT_TRUE(resting_segments(one_axis(60, 0.1, [](double) { return 0.0; })).empty()) << "vibration above the stated limit";
    EXPECT_TRUE(resting_segments({}).empty());
}

TEST(RestingSegments, do_not_contain_a_slow_turn)
{
    const auto samples = one_axis(90, 1e-3, [](double t) { return t < 60 ? 0.01 : 0.1; });
    const auto segments = resting_segments(samples);
    ASSERT_EQ(segments.size(), 1U);
    EXPECT_LE(samples[segments[0].end - 1].time_s, 60.0);
}

TEST(RestingSegments, end_at_gaps_and_missing_axes)
{
    auto samples = one_axis(60, 1e-3, [](double) { return 0.01; });
    EXPECT_EQ(resting_segments(samples).size(), 1U);
    samples[3030].follows = false;
    samples[4530].complete = false;
    const auto segments = resting_segments(samples);
    ASSERT_EQ(segments.size(), 3U);
    for (const auto& segment : segments) {
        EXPECT_FALSE(segment.begin < 3030 && segment.end > 3030);
        EXPECT_FALSE(segment.begin <= 4530 && segment.end > 4530);
    }
}

TEST(RestFigures, are_bias_spread_and_noise)
{
    const auto samples = one_axis(200, 2e-3, [](double t) { return t < 100 ? 0.010 : 0.012; });
    const RestFigures figures = rest_figures(samples, {{0, 10000}, {10000, 20000}});
    EXPECT_NEAR(figures.bias_rad_s(0), 0.011, 6 * 2e-3 / std::sqrt(20000.0));
    EXPECT_NEAR(figures.bias_spread_rad_s(0), 0.002 / std::sqrt(2.0), 1e-4);
    EXPECT_NEAR(figures.deviation_rad_s(0), 2e-3, 6 * 2e-3 / std::sqrt(2 * 20000.0));
}

TEST(AllanDeviation, of_white_noise_falls_with_the_root_of_time)
{
    const double sigma = 2e-3;
    const auto samples = one_axis(400, sigma, [](double) { return 0.01; });
    const auto points = allan_deviation(samples, {{0, 20000}, {20000, 40000}});
    ASSERT_GE(points.size(), 12U);
    for (std::size_t i = 0; i < 8; ++i) {
        const double expected = sigma * std::sqrt(interval_s / points[i].tau_s);
        EXPECT_NEAR(points[i].deviation_rad_s(0), expected, 0.08 * expected) << points[i].tau_s << " s";
    }
    EXPECT_NEAR(allan_figures(points).random_walk_rad_sqrt_s(0), sigma * std::sqrt(interval_s), 0.03 * sigma * std::sqrt(interval_s));
}

TEST(AllanDeviation, of_a_ramp_grows_with_time)
{
    const double slope = 1e-3;  // rad/s per s: the deviation is slope * tau / sqrt(2)
    const auto samples = one_axis(100, 0.0, [&](double t) { return slope * t; });
    for (const auto& point : allan_deviation(samples, {{0, samples.size()}}))
        EXPECT_NEAR(point.deviation_rad_s(0), slope * point.tau_s / std::sqrt(2.0), 1e-6 * slope);
}

}  // namespace
}  // namespace quorient::calibration
