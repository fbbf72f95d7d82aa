#include "quorient/design/mission.hpp"
#include "quorient/geometry/layouts.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <cmath>

namespace quorient::design {
namespace {

constexpr std::uint64_t seed = 12;

/// Faults so large that the method cannot miss them: then only their number decides.
Mission unmistakable()
{
    return {.hours = 1000, .axis_failures_per_h = 2e-4, .least_fault_sigma = 300, .most_fault_sigma = 900, .trials = 2000};
}

Survival played(const char* layout, const Mission& mission, std::uint64_t with_seed = seed)
{
    return survival(geometry::layout(layout).value(), mission, with_seed).value();
}

double choose(unsigned n, unsigned k)
{
    return k == 0 ? 1 : choose(n, k - 1) * (n - k + 1) / k;
}

/// At most `failures` of n axes fail.
double binomial(unsigned n, unsigned failures, const Mission& mission)
{
    const double fails = 1 - std::exp(-mission.axis_failures_per_h * mission.hours);
    double sum = 0;
    for (unsigned k = 0; k <= failures; ++k) sum += choose(n, k) * std::pow(fails, k) * std::pow(1 - fails, n - k);
    return sum;
}

// Parity isolates as long as five axes are there: of n axes, n - 4 failures.
TEST(Survival, counts_the_failures_that_can_be_isolated_where_faults_are_unmistakable)
{
    for (const auto& [layout, n, failures] : {std::tuple("cone-5", 5U, 1U), std::tuple("dodecahedron", 6U, 2U), std::tuple("cone-8", 8U, 4U)}) {
        const Survival found = played(layout, unmistakable());
        EXPECT_NEAR(found.probability, binomial(n, failures, unmistakable()), 4 * found.standard_error) << layout << ", seed " << seed;
        EXPECT_GT(found.coverage.front(), 0.999);
        EXPECT_LT(found.standard_error, 0.01);
    }
}

TEST(Survival, of_three_axes_is_that_none_fails)
{
    const Mission mission = unmistakable();
    EXPECT_NEAR(played("orthogonal-3", mission).probability, std::exp(-3 * 0.2), 1e-12);
}

TEST(Survival, suffers_where_the_method_cannot_see_the_faults)
{
    Mission small = unmistakable();
    small.least_fault_sigma = 0.5;
    small.most_fault_sigma = 1;
    small.trials = 500;
    const Survival found = played("dodecahedron", small);
    EXPECT_LT(found.coverage.front(), 0.05);
    EXPECT_LT(found.probability, binomial(6, 0, small) + 0.05);
}

TEST(Survival, of_a_short_mission_is_sure_to_a_millionth)
{
    Mission mission = unmistakable();
    mission.hours = 10;
    mission.axis_failures_per_h = 1e-6;
    const Survival found = played("dodecahedron", mission);
    EXPECT_GT(found.probability, 1 - 6e-5);
    EXPECT_LT(found.standard_error, 1e-6);
}

TEST(Survival, of_four_axes_rests_on_the_prediction_of_motion)
{
    const Survival found = played("cone-4", unmistakable());
    EXPECT_GT(found.coverage.front(), 0.9);
    EXPECT_NEAR(found.probability, binomial(4, 1, unmistakable()), 0.05);
}

TEST(Survival, isolates_whole_instruments_where_whole_instruments_fail)
{
    Mission mission = unmistakable();
    mission.axis_failures_per_h = 0;
    mission.instrument_failures_per_h = 2e-4;
    // Three triads: one failure is isolated, two that are left contradict each other.
    const Survival three = played("triads-3", mission);
    const double fails = 1 - std::exp(-0.2);
    EXPECT_NEAR(three.probability, std::pow(1 - fails, 3) + 3 * fails * std::pow(1 - fails, 2), 4 * three.standard_error);
    EXPECT_NEAR(played("triads-2", mission).probability, std::exp(-0.4), 0.01);
}

TEST(Survival, loses_what_hangs_on_a_shared_part_without_having_to_isolate_it)
{
    Mission mission = unmistakable();
    mission.axis_failures_per_h = 0;
    mission.shared = {{2e-4, {0}}, {2e-4, {1}}};  // two of three triads may go
    EXPECT_NEAR(played("triads-3", mission).probability, 1, 1e-12);
    mission.shared = {{2e-4, {0, 1, 2}}};
    EXPECT_NEAR(played("triads-3", mission).probability, std::exp(-0.2), 1e-12);
}

TEST(Survival, depends_on_the_seed_and_not_on_the_order_of_work)
{
    const auto cluster = geometry::layout("cone-5").value();
    const ForEach backwards = [](std::size_t count, const std::function<void(std::size_t)>& task) {
        for (std::size_t i = count; i-- > 0;) task(i);
    };
    const double forwards = survival(cluster, unmistakable(), seed)->probability;
    EXPECT_EQ(survival(cluster, unmistakable(), seed, backwards)->probability, forwards);
    EXPECT_NE(survival(cluster, unmistakable(), seed + 1)->probability, forwards);
}

TEST(Survival, says_why_a_method_cannot_serve)
{
    Mission mission = unmistakable();
    mission.method = "voting";
    const auto refused = survival(geometry::layout("cone-5").value(), mission, seed);
    ASSERT_FALSE(refused);
    EXPECT_THAT(refused.error(), testing::HasSubstr("6"));
}

}  // namespace
}  // namespace quorient::design
