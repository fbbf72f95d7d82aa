#include "quorient/geometry/layouts.hpp"

#include "quorient/geometry/figures.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <cmath>

namespace quorient::geometry {
namespace {

using testing::HasSubstr;

TEST(Layouts, are_all_reachable_by_the_names_of_the_catalogue)
{
    const std::vector<std::string> names{
        "orthogonal-3", "orthogonal-3-plus-1", "cone-4",         "cone-3-axis",     "tetrad",          "tetrad-2",
        "cone-5",       "cone-5-printed",      "cone-6",         "dodecahedron",    "dodecahedron-h1", "dodecahedron-h2",
        "octahedron-6", "octahedron-8",        "tdof-symmetric", "tdof-orthogonal", "tdof-coplanar",   "guaranteed-cone"};
    const auto entries = catalogue();
    ASSERT_EQ(entries.size(), names.size() + 5);
    for (std::size_t k = 0; k < names.size(); ++k) {
        EXPECT_EQ(entries[k].name, names[k]);
        EXPECT_TRUE(layout(names[k])) << names[k];
    }
}

TEST(Layouts, are_unit_vectors_to_the_last_digit_save_the_printed_pentad)
{
    for (const CatalogueEntry& entry : catalogue()) {
        const auto cluster = layout(entry.name);
        if (!cluster || entry.name == "cone-5-printed") continue;
        EXPECT_LT((cluster->axes.rowwise().norm().array() - 1).abs().maxCoeff(), 3e-16) << entry.name;
    }
    EXPECT_NEAR((layout("cone-5-printed")->axes.rowwise().norm().array() - 1).abs().maxCoeff(), 6e-6, 1e-7);
}

TEST(Layouts, are_optimal_where_the_papers_say_so)
{
    for (const char* name : {"cone-4",
                             "cone-3-axis",
                             "tetrad",
                             "tetrad-2",
                             "cone-5",
                             "cone-6",
                             "dodecahedron",
                             "dodecahedron-h1",
                             "dodecahedron-h2",
                             "octahedron-6",
                             "octahedron-8",
                             "tdof-symmetric",
                             "guaranteed-cone",
                             "cone-7",
                             "cone-24",
                             "cone-axis-4",
                             "cone-axis-6",
                             "cone-axis-13",
                             "two-triads:1,2,3,17",
                             "triads-8"}) {
        const auto axes = layout(name)->axes;
        const Eigen::Matrix3d information = axes.transpose() * axes;
        EXPECT_LT((information - Eigen::Matrix3d::Identity() * static_cast<double>(axes.rows()) / 3).norm(), 2e-14) << name;
    }
}

TEST(Layouts, have_the_exact_pentad_behind_the_printed_decimals)
{
    EXPECT_LT((layout("cone-5")->axes - layout("cone-5-printed")->axes).cwiseAbs().maxCoeff(), 6e-6);
    EXPECT_EQ(layout("cone-5-printed")->axes(1, 0), -0.60075);
}

TEST(Layouts, correct_the_duplicated_axis_of_h11)
{
    const auto axes = layout("tdof-coplanar")->axes;
    EXPECT_EQ(axes.row(7), Eigen::RowVector3d(-.5, -.5, std::sqrt(2.0) / 2));
    EXPECT_GT(*minimum_angle_rad(axes), .5);
}

/// Paper 000's numbers: z of its example to the printed digits (z_2 printed 1085.35 and z_6 without its sign are misprints).
TEST(Layouts, have_the_order_and_signs_of_the_guaranteed_cone)
{
    const Eigen::Vector3d rate(-172.82, 604.19, -1284.63);
    AxisVector disturbance(6), printed(6);
    disturbance << .5, .1 + 20, -.8 - 50, -.01, -.02, .3;
    printed << -393.04, 1075.35, -612.73, -593.11, 1254.79, -761.19;
    EXPECT_LT((layout("guaranteed-cone")->axes * rate + disturbance - printed).cwiseAbs().maxCoeff(), 6e-3);
}

TEST(Layouts, name_the_instruments_of_two_axis_gyros_and_triads)
{
    EXPECT_THAT(layout("tdof-symmetric")->instrument, testing::ElementsAre(0, 0, 1, 1, 2, 2, 3, 3));
    EXPECT_THAT(layout("triads-2")->instrument, testing::ElementsAre(0, 0, 0, 1, 1, 1));
    EXPECT_THAT(layout("cone-4")->instrument, testing::ElementsAre(0, 1, 2, 3));
    EXPECT_EQ(layout("triads-8")->instrument_name.back(), "IMU8");
    EXPECT_EQ(layout("cone-4")->instrument_name[1], "G2");
}

TEST(Families, start_at_azimuth_zero)
{
    for (const char* name : {"cone-7", "cone-axis-7", "two-cones:30,20,10"}) {
        const auto axes = layout(name)->axes;
        EXPECT_GT(axes(0, 0), 0) << name;
        EXPECT_EQ(axes(0, 1), 0) << name;
    }
}

TEST(Families, give_way_to_named_entries)
{
    EXPECT_GT(layout("cone-4")->axes(0, 0), 0);
    EXPECT_LT(layout("cone-4")->axes(0, 1), 0);  // paper 003's first axis, not azimuth 0
}

TEST(Families, build_the_dodecahedron_from_two_cones_and_from_a_cone_with_axis)
{
    const auto dodecahedron = [](const char* name) {
        const auto axes = layout(name)->axes;
        AxisMatrix cosines = (axes * axes.transpose()).cwiseAbs();
        cosines.diagonal().setConstant(1 / std::sqrt(5.0));
        return (cosines.array() - 1 / std::sqrt(5.0)).abs().maxCoeff();
    };
    EXPECT_LT(dodecahedron("cone-axis-6"), 1e-15);
    EXPECT_LT(dodecahedron("two-cones:52.622631,10.812317,60"), 1e-7);
    EXPECT_GT(dodecahedron("cone-6"), .1);
}

TEST(Families, turn_the_second_triad_about_the_given_axis)
{
    const auto axes = layout("two-triads:0,0,2,90")->axes;
    EXPECT_LT((axes.row(3) - Eigen::RowVector3d(0, 1, 0)).norm(), 1e-15);
    EXPECT_LT((axes.row(4) - Eigen::RowVector3d(-1, 0, 0)).norm(), 1e-15);
}

TEST(Families, refuse_numbers_outside_their_range)
{
    for (const char* name :
         {"cone-2", "cone-25", "cone-99999999999", "cone-axis-3", "cone-axis-25", "triads-0", "triads-9", "cone-N", "cone-"})
        EXPECT_THAT(layout(name).error(), HasSubstr("the number must be")) << name;
    for (const char* name : {"two-cones:1,2", "two-cones:1,2,3,4", "two-cones:1,2,x", "two-cones:", "two-cones:1,,3", "two-triads:1,1,1",
                             "two-triads:1,1,1,nan"})
        EXPECT_THAT(layout(name).error(), HasSubstr("numbers separated by commas are needed")) << name;
    EXPECT_THAT(layout("two-triads:0,0,0,10").error(), HasSubstr("has no length"));
    EXPECT_THAT(layout("two-cones:0,0,60").error(), HasSubstr("in one plane"));
}

TEST(Layouts, suggest_the_nearest_name_for_a_misspelt_one)
{
    EXPECT_EQ(layout("dodecahedrn").error(), "unknown layout 'dodecahedrn'; did you mean 'dodecahedron'?");
    EXPECT_THAT(layout("cone-5-print").error(), HasSubstr("'cone-5-printed'"));
    EXPECT_THAT(layout("").error(), HasSubstr("unknown layout ''"));
    EXPECT_THAT(layout("Tetrad").error(), HasSubstr("'tetrad'"));
}

}  // namespace
}  // namespace quorient::geometry
