// The search finds what is known to be best, without knowing it.

#include "briefs.hpp"
#include "quorient/design/recognise.hpp"
#include "quorient/design/mission.hpp"
#include "quorient/design/search.hpp"
#include "quorient/geometry/layouts.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <Eigen/Geometry>
#include <algorithm>

namespace quorient::design {
namespace {

constexpr double exact = 1e-9;

SearchSettings settings_of(Objective objective = Objective::trace, std::uint64_t seed = 1)
{
    return {.objective = objective, .seed = seed, .starts = 16};
}

SearchResult found(const Brief& brief, const SearchSettings& settings = settings_of())
{
    auto result = search(brief, settings);
    EXPECT_TRUE(result) << result.error().reason;
    return result.value_or(SearchResult{});
}

Design best(const Brief& brief, const SearchSettings& settings = settings_of())
{
    const SearchResult result = found(brief, settings);
    EXPECT_FALSE(result.designs.empty());
    return result.designs.empty() ? Design{} : result.designs.front();
}

/// The figures of the layout are found to 1e-9.
void expect_same(const Figures& figures, const char* layout)
{
    const auto cluster = geometry::layout(layout).value();
    const Figures known = judge(cluster.axes, Yardstick::of(cluster, static_cast<unsigned>(figures.worst_after.size())));
    EXPECT_NEAR(figures.trace, known.trace, exact);
    EXPECT_NEAR(figures.volume, known.volume, exact);
    EXPECT_NEAR(figures.condition, known.condition, exact);
    EXPECT_NEAR(figures.minimum_angle_rad, known.minimum_angle_rad, exact);
    EXPECT_NEAR(figures.f_d1, known.f_d1, exact);
    EXPECT_NEAR(figures.f_d2, known.f_d2, 1e-8);
    for (std::size_t k = 0; k < known.worst_after.size(); ++k) {
        EXPECT_NEAR(figures.worst_after[k].trace, known.worst_after[k].trace, 1e-8);
        EXPECT_NEAR(figures.worst_after[k].volume, known.worst_after[k].volume, 1e-8);
    }
}

TEST(Search, finds_the_tetrahedral_set_of_four_axes)
{
    const Design four = best(single_axes(4));
    expect_same(four.figures, "tetrad");
    EXPECT_EQ(same_as(four.cluster.axes), "cone-4");
}

TEST(Search, finds_the_five_cone)
{
    const Design five = best(single_axes(5));
    expect_same(five.figures, "cone-5");
    EXPECT_EQ(five.symmetry, 5U);
}

TEST(Search, finds_the_dodecahedron_with_every_seed)
{
    for (const std::uint64_t seed : {1U, 2U, 3U}) {
        const Design six = best(single_axes(6), settings_of(Objective::trace, seed));
        expect_same(six.figures, "dodecahedron");
        EXPECT_EQ(same_as(six.cluster.axes), "dodecahedron");
    }
}

TEST(Search, finds_the_best_two_cones_52_6226_and_10_8123_degrees_above_the_plane_60_degrees_apart)
{
    const Design six = best(single_axes(6, SymmetricMounting{Eigen::Vector3d::UnitZ(), 3}));
    std::vector<double> elevation_deg, azimuth_deg;
    for (Eigen::Index axis = 0; axis < 6; ++axis) {
        Eigen::Vector3d row = six.cluster.axes.row(axis);
        if (row.z() < 0) row = -row;
        elevation_deg.push_back(std::asin(row.z()) / degree);
        azimuth_deg.push_back(std::atan2(row.y(), row.x()) / degree);
    }
    if (elevation_deg[0] < elevation_deg[3]) {
        std::rotate(elevation_deg.begin(), elevation_deg.begin() + 3, elevation_deg.end());
        std::rotate(azimuth_deg.begin(), azimuth_deg.begin() + 3, azimuth_deg.end());
    }
    EXPECT_NEAR(elevation_deg[0], 52.6226, 5e-5);
    EXPECT_NEAR(elevation_deg[3], 10.8123, 5e-5);
    EXPECT_NEAR(std::abs(std::remainder(azimuth_deg[3] - azimuth_deg[0], 120)), 60, 1e-6);
}

TEST(Search, finds_the_best_rotation_of_two_triads)
{
    const Design two = best(triads(2));
    EXPECT_NEAR(two.figures.minimum_angle_rad / degree, 48.189685104, 1e-8);
    EXPECT_EQ(same_as(two.cluster.axes), "cone-6");
    EXPECT_EQ(two.cluster.instrument, (std::vector<std::size_t>{0, 0, 0, 1, 1, 1}));
    for (Eigen::Index first : {0, 3}) {  // instruments stay what they are
        const Eigen::Matrix3d own = two.cluster.axes.middleRows(first, 3);
        EXPECT_NEAR((own * own.transpose() - Eigen::Matrix3d::Identity()).norm(), 0, 1e-12);
        EXPECT_NEAR(own.determinant(), 1, 1e-12);
    }
}

// Conway, Hardin & Sloane's table of packings in projective space has four decimals.
TEST(Search, finds_the_best_known_spacings_of_lines)
{
    EXPECT_NEAR(best(single_axes(7), settings_of(Objective::minimum_angle)).figures.minimum_angle_rad / degree, 54.7356, 5e-5);
    EXPECT_NEAR(best(single_axes(8), settings_of(Objective::minimum_angle)).figures.minimum_angle_rad / degree, 49.6399, 5e-5);
}

TEST(Search, is_the_same_whatever_the_order_of_work)
{
    const ForEach backwards = [](std::size_t count, const std::function<void(std::size_t)>& task) {
        for (std::size_t i = count; i-- > 0;) task(i);
    };
    for (const Brief& brief : {single_axes(7), triads(3, WedgeMounting{{0, 30 * degree}, {0, 1, 2, 3}, {}})}) {
        const auto forwards = search(brief, settings_of());
        const auto reversed = search(brief, settings_of(), backwards);
        ASSERT_EQ(forwards->designs.size(), reversed->designs.size());
        for (std::size_t k = 0; k < forwards->designs.size(); ++k) EXPECT_EQ(forwards->designs[k].cluster.axes, reversed->designs[k].cluster.axes);
    }
}

TEST(Search, never_keeps_a_design_that_another_beats_in_everything)
{
    const SearchResult result = found(single_axes(8));
    for (const Design& one : result.designs)
        for (const Design& other : result.designs)
            if (&one != &other) {
                EXPECT_FALSE(as_good(other.figures, one.figures, Objective::trace) && better(other.figures, one.figures, Objective::trace) &&
                             !as_good(one.figures, other.figures, Objective::trace));
            }
}

TEST(Search, agrees_by_exchange_with_every_choice)
{
    const std::vector<double> sixths{0, 60 * degree, 120 * degree, 180 * degree, 240 * degree, 300 * degree};
    const WedgeMounting wedges{{0, 30 * degree, 45 * degree, 60 * degree}, sixths, {0, 45 * degree}};
    for (const Brief& brief : {single_axes(5, wedges), single_axes(6, RightAngleMounting{}), triads(3, wedges)})
        for (const Objective objective : {Objective::trace, Objective::worst_trace, Objective::f_d2, Objective::minimum_angle}) {
            SearchSettings settings = settings_of(objective);
            settings.places = PlaceSearch::exhaustive;
            const SearchResult all = found(brief, settings);
            EXPECT_EQ(all.searched, Searched::wholly);
            settings.places = PlaceSearch::exchange;
            const SearchResult some = found(brief, settings);
            EXPECT_EQ(some.searched, Searched::by_exchange);
            const double by_all = cost(all.designs.front().figures, objective), by_exchange = cost(some.designs.front().figures, objective);
            EXPECT_TRUE(by_exchange == by_all || std::abs(by_exchange - by_all) < exact) << by_exchange << " " << by_all;  // both may be infinite
        }
}

TEST(Search, keeps_the_smallest_angle_that_is_demanded)
{
    Brief brief = single_axes(8);
    SearchSettings settings = settings_of();
    settings.starts = 4;
    const Design free = best(brief, settings);
    brief.minimum_angle_rad = 49 * degree;
    const Design spaced = best(brief, settings);
    EXPECT_LT(free.figures.minimum_angle_rad, brief.minimum_angle_rad);
    EXPECT_GE(spaced.figures.minimum_angle_rad, brief.minimum_angle_rad - exact);
    EXPECT_GT(spaced.figures.trace, free.figures.trace);  // it costs something
}

TEST(Search, keeps_tilts_within_the_tolerance_of_a_face)
{
    FaceMounting faces;
    for (int part = 0; part < 3; ++part) faces.faces.push_back({.normal = Eigen::Vector3d::Unit(part), .tolerance_rad = 10 * degree, .holds = 2});
    const Design six = best(single_axes(6, faces));
    for (Eigen::Index axis = 0; axis < 6; ++axis)
        EXPECT_GE(six.cluster.axes.row(axis).maxCoeff(), std::cos(10 * degree) - exact);
    EXPECT_NEAR(six.figures.minimum_angle_rad / degree, 20, 1e-6);  // the two of each face as far apart as it lets them
}

TEST(Search, finds_the_same_array_in_any_unit_of_noise)
{
    for (const double noise : {1e-6, 1e4}) {
        Brief brief = single_axes(6);
        brief.noise = {noise};
        const Design six = best(brief);
        EXPECT_EQ(same_as(six.cluster.axes), "dodecahedron") << noise;
        EXPECT_NEAR(six.figures.trace / (noise * noise), 1.5, exact) << noise;
        EXPECT_NEAR(six.figures.worst_after[1].trace / (noise * noise), 3, 1e-8) << noise;
    }
}

TEST(Search, meets_demands_on_places_and_is_then_the_best_of_every_choice)
{
    const std::vector<double> sixths{0, 60 * degree, 120 * degree, 180 * degree, 240 * degree, 300 * degree};
    Brief brief = single_axes(5, WedgeMounting{{0, 30 * degree, 45 * degree, 60 * degree}, sixths, {}});
    const Design free = best(brief);
    const double widest = best(brief, settings_of(Objective::minimum_angle)).figures.minimum_angle_rad;
    ASSERT_LT(free.figures.minimum_angle_rad, widest - 1e-6);
    brief.minimum_angle_rad = (free.figures.minimum_angle_rad + widest) / 2;
    SearchSettings settings = settings_of();
    const Design all = best(brief, settings);
    EXPECT_GE(all.figures.minimum_angle_rad, brief.minimum_angle_rad - exact);
    settings.places = PlaceSearch::exchange;
    EXPECT_NEAR(best(brief, settings).figures.trace, all.figures.trace, exact);
}

TEST(Failures, are_named_by_parity_where_two_more_axes_may_be_missing)
{
    const auto named = [](const char* layout) {
        const auto cluster = geometry::layout(layout).value();
        return named_in_turn(judge(cluster.axes, Yardstick::of(cluster, 1)));
    };
    EXPECT_EQ(named("dodecahedron"), 2U);
    EXPECT_EQ(named("cone-5"), 1U);
    EXPECT_EQ(named("cone-4"), 0U);
    EXPECT_EQ(named("triads-2"), 0U);  // two parallel axes show alike
    EXPECT_EQ(named("triads-3"), 1U);
}

TEST(Failures, that_no_choice_of_places_lets_parity_name_leave_designs_that_still_measure)
{
    Brief brief = single_axes(6, RightAngleMounting{});
    brief.failures = 1;
    const Design six = best(brief);
    EXPECT_NEAR(six.figures.worst_after[0].trace, 2, exact);
    EXPECT_FALSE(names_failures(six.figures, brief));
    brief.instruments = 9;
    EXPECT_TRUE(names_failures(best(brief).figures, brief));
}

TEST(Search, says_what_came_nearest_where_nothing_meets_a_limit)
{
    Brief brief = single_axes(5);
    brief.limits = {{2, 6.0, {}, {}}};  // above the bound of 5.4, below what is known
    SearchSettings settings = settings_of();
    settings.starts = 4;
    const SearchResult result = found(brief, settings);
    EXPECT_TRUE(result.designs.empty());
    ASSERT_EQ(result.nearest.size(), 1U);
    EXPECT_GT(result.nearest.front().figures.worst_after[1].trace, 6.0);
    brief.limits = {{2, 9.3, {}, {}}};
    EXPECT_FALSE(found(brief, settings).designs.empty());
}

TEST(Search, puts_the_better_objective_first)
{
    for (const auto& entry : objectives()) {
        if (entry.objective == Objective::survival) continue;
        Brief brief = single_axes(5);
        brief.mounting_error_rad = degree;
        SearchSettings settings = settings_of(entry.objective);
        settings.starts = 1;
        const SearchResult result = found(brief, settings);
        for (std::size_t k = 1; k < result.designs.size(); ++k)
            EXPECT_LE(cost(result.designs[k - 1].figures, entry.objective), cost(result.designs[k].figures, entry.objective) + 1e-7) << entry.name;
    }
}

TEST(Search, for_survival_is_not_beaten_by_the_common_cones)
{
    Brief brief = single_axes(7);
    brief.mission = Mission{.hours = 87'660, .axis_failures_per_h = 2e-6, .trials = 500};
    SearchSettings settings = settings_of(Objective::survival);
    settings.starts = 2;
    const double reached = best(brief, settings).figures.survival->probability;
    for (const char* layout : {"cone-7", "cone-axis-7"})
        EXPECT_GE(reached, survival(geometry::layout(layout).value(), *brief.mission, settings.seed)->probability) << layout;
}

TEST(MountedTrace, of_a_vanishing_error_is_that_of_the_array_as_designed)
{
    for (const char* layout : {"cone-5", "dodecahedron", "cone-8", "triads-3"}) {
        auto yardstick = Yardstick::of(geometry::layout(layout).value(), 2);
        yardstick.mounting_error_rad = 1e-10;
        const Figures figures = judge(geometry::layout(layout)->axes, yardstick);
        EXPECT_NEAR(*figures.mounted_trace / figures.worst_after.back().trace, 1, 1e-8) << layout;
    }
}

TEST(MountedTrace, is_infinite_where_a_failure_leaves_no_three_directions)
{
    geometry::Axes axes(5, 3);
    axes << 1, 0, 0, 1, 0, 0, 0, 1, 0, 0, 1, 0, 0, 0, 1;
    Yardstick yardstick{geometry::AxisVector::Ones(5), {0, 1, 2, 3, 3}, false, 1, 1e-300, 1};
    EXPECT_EQ(*judge(axes, yardstick).mounted_trace, std::numeric_limits<double>::infinity());
}

TEST(Search, refines_objectives_without_derivatives_too)
{
    Brief brief = single_axes(5, ConeMounting{40 * degree});  // no array on it is isotropic
    SearchSettings settings = settings_of(Objective::worst_condition);
    const double reached = best(brief, settings).figures.worst_after.back().condition;
    settings.objective = Objective::trace;
    EXPECT_LE(reached, best(brief, settings).figures.worst_after.back().condition * (1 + 1e-9));
}

TEST(Growing, puts_the_fourth_axis_on_the_diagonal_and_keeps_the_others)
{
    Brief brief = single_axes(1);
    brief.kept = geometry::layout("orthogonal-3")->axes;
    const Design grown = best(brief, settings_of(Objective::worst_trace));
    EXPECT_EQ(grown.cluster.axes.topRows(3), geometry::Axes(geometry::layout("orthogonal-3")->axes));
    EXPECT_EQ(same_as(grown.cluster.axes), "orthogonal-3-plus-1");
}

TEST(Removal, of_an_axis_costs_least_where_another_one_points_the_same_way)
{
    geometry::Axes axes(5, 3);
    axes << geometry::layout("orthogonal-3-plus-1")->axes, 1, 0, 0;
    const auto cluster = geometry::make_cluster(axes).value();
    const auto list = removals(cluster, false, 1, Objective::trace);
    ASSERT_EQ(list.size(), 5U);
    EXPECT_THAT(list.front().unit, testing::AnyOf(0U, 4U));
    for (const Removal& removal : list) {
        geometry::Axes left(4, 3);
        Eigen::Index next = 0;
        for (Eigen::Index axis = 0; axis < 5; ++axis)
            if (static_cast<std::size_t>(axis) != removal.unit) left.row(next++) = axes.row(axis);
        EXPECT_DOUBLE_EQ(removal.figures.trace, (left.transpose() * left).inverse().trace());
    }
}

TEST(Removal, of_an_instrument_takes_all_its_axes)
{
    const auto cluster = geometry::layout("triads-4").value();
    const auto list = removals(cluster, true, 1, Objective::trace);
    ASSERT_EQ(list.size(), 4U);
    for (const Removal& removal : list) EXPECT_NEAR(removal.figures.trace, 1, 1e-12);
}

TEST(Upright, shows_the_symmetry_of_known_layouts)
{
    EXPECT_EQ(upright(geometry::layout("dodecahedron-h1")->axes, true).symmetry, 5U);
    EXPECT_EQ(upright(geometry::layout("guaranteed-cone")->axes, true).symmetry, 6U);
    EXPECT_EQ(upright(geometry::layout("cone-axis-8")->axes, true).symmetry, 7U);
    const Upright turned = upright(geometry::layout("cone-5")->axes, true);
    EXPECT_EQ(same_as(turned.axes), "cone-5");
    for (Eigen::Index axis = 0; axis < 5; ++axis) EXPECT_NEAR(turned.axes(axis, 2), std::numbers::inv_sqrt3, 1e-12);
}

TEST(SameAs, knows_a_layout_in_any_order_and_turn_and_nothing_else)
{
    geometry::Axes axes = geometry::layout("octahedron-8")->axes;
    axes.row(0).swap(axes.row(5));
    axes.row(3) *= -1;
    axes = axes * Eigen::AngleAxisd(1, Eigen::Vector3d(1, 2, 3).normalized()).toRotationMatrix();
    EXPECT_EQ(same_as(axes), "octahedron-8");
    axes.row(3) = (axes.row(3) + Eigen::RowVector3d(0.001, 0, 0)).normalized();
    EXPECT_EQ(same_as(axes), "");
}

}  // namespace
}  // namespace quorient::design
