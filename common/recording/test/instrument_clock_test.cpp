#include "quorient/recording/instrument_clock.hpp"

#include <gtest/gtest.h>
#include <cmath>
#include <random>
#include <vector>

namespace quorient::recording {
namespace {

/// An instrument of its own clock whose samples a host stamps late.
struct Arrivals {
    std::vector<std::int64_t> taken_ns;  // truth
    std::vector<std::int64_t> stamp_ns;
    std::uint64_t lost = 0;
};

/// @param lost_at  numbers of samples before which so many are lost
/// @param late     a spell of lateness: from, to [s], how much [s]
Arrivals arrivals(double period_s, double duration_s, const std::vector<std::pair<int, int>>& lost_at, const std::array<double, 3>& late,
                  unsigned seed)
{
    std::mt19937 random(seed);
    std::exponential_distribution<double> usual_delay(1 / 0.4e-3);
    Arrivals made;
    double taken_s = 3.0;
    for (int number = 0; taken_s < duration_s; ++number) {
        taken_s += period_s;
        for (const auto& [at, count] : lost_at)
            if (at == number) taken_s += count * period_s, made.lost += static_cast<std::uint64_t>(count);
        double stamp_s = taken_s + usual_delay(random);
        if (taken_s > late[0] && taken_s < late[1]) stamp_s += late[2];
        stamp_s = std::floor(stamp_s * 1e3) * 1e-3;  // the host's clock steps by 1 ms
        made.taken_ns.push_back(std::llround(taken_s * 1e9));
        made.stamp_ns.push_back(std::llround(stamp_s * 1e9));
    }
    return made;
}

double period_of(const Arrivals& given, double guess_s)
{
    PeriodEstimator estimator(guess_s);
    for (const std::int64_t stamp_ns : given.stamp_ns) estimator.add(stamp_ns);
    return estimator.period_s().value();
}

TEST(PeriodEstimator, is_exact_although_stamps_are_late_and_samples_lost)
{
    for (const unsigned seed : {1U, 2U, 3U}) {
        SCOPED_TRACE(seed);
        const double period_s = 1 / 104.37;
        const Arrivals given = arrivals(period_s, 70, {{800, 3}, {2000, 1}, {2001, 1}, {4000, 9}}, {30, 34, 0.042}, seed);
        EXPECT_NEAR(period_of(given, period_s * 1.002) / period_s, 1, 2e-5);
    }
}

TEST(PeriodEstimator, says_nothing_of_a_few_samples)
{
    PeriodEstimator estimator(0.01);
    for (int i = 0; i < 100; ++i) estimator.add(i * 10'000'000);
    EXPECT_FALSE(estimator.period_s());
}

struct Placed {
    double worst_s = 0;  ///< off the truth, but for a constant
    std::uint64_t lost = 0;
    double late_most_s = 0;
};

Placed placed(const Arrivals& given, double period_s)
{
    ArrivalClock clock(period_s);
    std::vector<double> off_s;
    Placed result;
    std::size_t number = 0;
    const auto take = [&] {
        while (const auto placement = clock.next()) {
            off_s.push_back(static_cast<double>(placement->time_ns - given.taken_ns[number++]) * 1e-9);
            result.lost += placement->lost;
            result.late_most_s = std::max(result.late_most_s, placement->late_s);
        }
    };
    for (const std::int64_t stamp_ns : given.stamp_ns) {
        clock.add(stamp_ns);
        take();
    }
    clock.finish();
    take();
    EXPECT_EQ(number, given.taken_ns.size());
    const auto [least, most] = std::minmax_element(off_s.begin(), off_s.end());
    result.worst_s = *most - *least;
    return result;
}

TEST(ArrivalClock, places_late_samples_where_they_were_taken)
{
    const double period_s = 1 / 104.37;
    for (const unsigned seed : {4U, 5U, 6U}) {
        SCOPED_TRACE(seed);
        const Arrivals given = arrivals(period_s, 70, {}, {30, 34, 0.042}, seed);
        const Placed found = placed(given, period_of(given, period_s));
        EXPECT_LT(found.worst_s, 2e-3) << "stamps are up to 42 ms late";
        EXPECT_EQ(found.lost, 0U) << "late is not lost";
        EXPECT_NEAR(found.late_most_s, 0.044, 0.004);
    }
}

TEST(ArrivalClock, counts_lost_samples_as_whole_periods)
{
    const double period_s = 1 / 104.37;
    const Arrivals given = arrivals(period_s, 70, {{800, 3}, {2000, 1}, {2001, 1}, {4000, 9}}, {30, 34, 0.042}, 7);
    const Placed found = placed(given, period_of(given, period_s));
    EXPECT_EQ(found.lost, given.lost);
    EXPECT_LT(found.worst_s, 2e-3);
}

TEST(ArrivalClock, begins_again_where_the_stamps_step)
{
    ArrivalClock clock(0.01);
    for (int i = 0; i < 100; ++i) clock.add(i * 10'000'000LL);
    for (int i = 0; i < 100; ++i) clock.add(500'000'000'000LL + i * 10'000'000LL);
    clock.finish();
    std::vector<Placement> all;
    while (const auto placement = clock.next()) all.push_back(*placement);
    ASSERT_EQ(all.size(), 200U);
    for (std::size_t i = 0; i < 200; ++i) EXPECT_EQ(all[i].restarted, i % 100 == 0) << i;
    EXPECT_EQ(all[150].time_ns, 500'500'000'000LL);
    EXPECT_EQ(all[150].lost, 0U);
}

}  // namespace
}  // namespace quorient::recording
