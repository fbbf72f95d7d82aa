#include "briefs.hpp"
#include "quorient/design/bounds.hpp"
#include "quorient/design/figures.hpp"
#include "quorient/geometry/layouts.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <random>

namespace quorient::design {
namespace {

using testing::HasSubstr;

Figures figures_of(const char* layout)
{
    const auto cluster = geometry::layout(layout).value();
    return judge(cluster.axes, Yardstick::of(cluster, 2));
}

geometry::Axes random_axes(Eigen::Index count, std::mt19937_64& random)
{
    std::normal_distribution<double> normal;
    geometry::Axes axes(count, 3);
    for (Eigen::Index axis = 0; axis < count; ++axis) {
        for (Eigen::Index part = 0; part < 3; ++part) axes(axis, part) = normal(random);
        axes.row(axis).normalize();
    }
    return axes;
}

TEST(Bounds, are_nine_over_n_and_three_over_n_to_the_three_halves)
{
    for (const std::size_t n : {3U, 4U, 6U, 24U}) {
        const Bounds found = bounds(single_axes(n));
        EXPECT_DOUBLE_EQ(found.trace, 9.0 / static_cast<double>(n));
        EXPECT_DOUBLE_EQ(found.volume, std::pow(3.0 / static_cast<double>(n), 1.5));
    }
}

TEST(Bounds, count_better_axes_for_more)
{
    Brief brief = single_axes(4);
    brief.noise = {0.5, 1, 1, 1};
    EXPECT_DOUBLE_EQ(bounds(brief).trace, 9.0 / 7);
}

// Paper 002's table of the dodecahedron: the bounds after failures are reached, so nothing can beat it there.
TEST(Bounds, after_failures_are_met_by_the_dodecahedron)
{
    const Figures figures = figures_of("dodecahedron");
    const Bounds bound = bounds(single_axes(6));
    for (std::size_t k = 0; k < 2; ++k) {
        EXPECT_NEAR(figures.worst_after[k].trace, bound.worst_after[k].trace, 1e-12);
        EXPECT_NEAR(figures.worst_after[k].volume, bound.worst_after[k].volume, 1e-12);
    }
    EXPECT_NEAR(figures.f_d1, bound.f_d1, 1e-12);
    EXPECT_NEAR(figures.f_d2, bound.f_d2, 1e-12);
    EXPECT_NEAR(figures.minimum_angle_rad, bound.minimum_angle_rad, 1e-12);
}

TEST(Bounds, are_passed_by_no_random_array)
{
    constexpr unsigned seed = 20;
    std::mt19937_64 random(seed);
    for (int trial = 0; trial < 800; ++trial) {
        SCOPED_TRACE("seed " + std::to_string(seed) + ", trial " + std::to_string(trial));
        const auto n = 4 + trial % 6;
        const Brief brief = single_axes(static_cast<std::size_t>(n));
        const Bounds bound = bounds(brief);
        const Figures figures = judge(random_axes(n, random), Yardstick::of(brief, 1));
        ASSERT_GE(figures.trace, bound.trace * (1 - 1e-12));
        ASSERT_GE(figures.volume, bound.volume * (1 - 1e-12));
        for (std::size_t k = 0; k < bound.worst_after.size(); ++k) {
            ASSERT_GE(figures.worst_after[k].trace, bound.worst_after[k].trace * (1 - 1e-12));
            ASSERT_GE(figures.worst_after[k].volume, bound.worst_after[k].volume * (1 - 1e-12));
        }
        ASSERT_LE(figures.f_d1, bound.f_d1 * (1 + 1e-12));
        ASSERT_LE(figures.f_d2, bound.f_d2 * (1 + 1e-12));
        ASSERT_LE(figures.minimum_angle_rad, bound.minimum_angle_rad + 1e-12);
        ASSERT_LE(figures.detectable, bound.detectable);
        ASSERT_LE(figures.isolable, bound.isolable);
    }
}

TEST(Bounds, after_whole_instruments_are_met_by_any_two_triads)
{
    Brief brief = triads(3);
    brief.instrument_faults = true;
    const auto cluster = geometry::layout("triads-3").value();
    const Figures figures = judge(cluster.axes, Yardstick::of(brief, 1));
    for (std::size_t k = 0; k < 2; ++k) EXPECT_NEAR(figures.worst_after[k].trace, bounds(brief).worst_after[k].trace, 1e-12);
}

TEST(SmallestAngle, is_that_of_the_known_best_lines)
{
    EXPECT_NEAR(largest_minimum_angle_rad(3) / degree, 90, 1e-12);
    EXPECT_NEAR(largest_minimum_angle_rad(4) / degree, 70.528779, 1e-6);
    EXPECT_NEAR(largest_minimum_angle_rad(6) / degree, 63.434949, 1e-6);
    EXPECT_NEAR(largest_minimum_angle_rad(7) / degree, 54.735610, 1e-6);
    EXPECT_GT(largest_minimum_angle_rad(8) / degree, 49.6399);  // the best known
    EXPECT_GT(largest_minimum_angle_rad(12) / degree, 41.8820);
    EXPECT_LT(largest_minimum_angle_rad(12) / degree, 45);
}

/// The demand that is to blame, and why.
Refusal refusal(const Brief& brief)
{
    const auto checked = check(brief);
    EXPECT_FALSE(checked);
    return checked ? Refusal{} : checked.error();
}

TEST(Demands, of_two_isolable_faults_on_five_axes_are_refused_with_the_number_that_is_needed)
{
    Brief at_once = single_axes(5);
    at_once.isolable = 2;
    EXPECT_EQ(refusal(at_once).demand, "isolable");
    EXPECT_THAT(refusal(at_once).reason, HasSubstr("7 axes are needed"));
    Brief in_turn = single_axes(5);
    in_turn.failures = 2;
    EXPECT_EQ(refusal(in_turn).demand, "failures");
    EXPECT_THAT(refusal(in_turn).reason, HasSubstr("6 axes are needed"));
}

TEST(Demands, that_can_be_met_are_not_refused)
{
    Brief seven = single_axes(7);
    seven.isolable = 2;
    seven.detectable = 4;
    EXPECT_TRUE(check(seven));
    Brief six = single_axes(6);
    six.failures = 2;
    six.minimum_angle_rad = 63.4349 * degree;
    six.limits = {{2, 3.0, 0.7906, {}}};
    EXPECT_TRUE(check(six)) << check(six).error().reason;
    Brief four = single_axes(4);
    four.failures = 1;  // by prediction: the method of four axes
    EXPECT_TRUE(check(four));
}

TEST(Demands, beyond_a_bound_are_refused)
{
    Brief angle = single_axes(6);
    angle.minimum_angle_rad = 64 * degree;
    EXPECT_THAT(refusal(angle).reason, HasSubstr("63.4349"));
    Brief trace = single_axes(6);
    trace.limits = {{2, 2.99, {}, {}}};
    EXPECT_THAT(refusal(trace).reason, HasSubstr("no 6 axes do better than 3"));
    Brief many = single_axes(25);
    EXPECT_EQ(refusal(many).demand, "axes");
    Brief countless = single_axes(24);
    countless.failures = 12;
    EXPECT_THAT(refusal(countless).reason, HasSubstr("2704156 ways"));
    Brief few = single_axes(2);
    EXPECT_EQ(refusal(few).demand, "axes");
    Brief instruments = triads(2);
    instruments.instrument_faults = true;
    instruments.failures = 1;
    EXPECT_THAT(refusal(instruments).reason, HasSubstr("3 are needed"));
}

TEST(Mountings, that_contradict_themselves_are_refused)
{
    const auto reason = [](const Brief& brief) {
        const Refusal found = refusal(brief);
        EXPECT_EQ(found.demand, "mounting");
        return found.reason;
    };
    EXPECT_THAT(reason(single_axes(6, SymmetricMounting{Eigen::Vector3d::UnitZ(), 4})), HasSubstr("groups of 4"));
    EXPECT_THAT(reason(triads(2, ConeMounting{40 * degree})), HasSubstr("54.7356"));
    EXPECT_THAT(reason(single_axes(5, FaceMounting{{Face{.holds = 2}, Face{.normal = Eigen::Vector3d::UnitX(), .holds = 2}}})), HasSubstr("hold 4"));
    EXPECT_THAT(reason(single_axes(4, FaceMounting{{Face{}, Face{.normal = Eigen::Vector3d::UnitX()}}})), HasSubstr("in one plane"));
    Brief spaced = single_axes(4, RightAngleMounting{});
    spaced.minimum_angle_rad = 10 * degree;
    EXPECT_THAT(reason(spaced), HasSubstr("three directions"));
    EXPECT_TRUE(check(single_axes(6, SymmetricMounting{Eigen::Vector3d::UnitZ(), 5})));
    EXPECT_TRUE(check(single_axes(4, FaceMounting{{Face{}, Face{.normal = Eigen::Vector3d::UnitX()}, Face{.normal = Eigen::Vector3d::UnitY()}}})));
}

}  // namespace
}  // namespace quorient::design
