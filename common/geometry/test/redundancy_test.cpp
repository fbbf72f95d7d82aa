#include "quorient/geometry/redundancy.hpp"

#include "quorient/geometry/layouts.hpp"
#include "quorient/geometry/parity_space.hpp"

#include <gtest/gtest.h>
#include <Eigen/SVD>
#include <bit>
#include <random>

namespace quorient::geometry {
namespace {

/// Are every k columns of V independent? By the definition: every subset, a rank each.
bool every_columns_independent(const AxisMatrix& v, int k)
{
    const auto n = static_cast<int>(v.cols());
    if (k > v.rows()) return false;
    for (AxisMask set = 0; set < axis_bit(static_cast<std::size_t>(n)); ++set) {
        if (std::popcount(set) != k) continue;
        Eigen::MatrixXd columns(v.rows(), k);
        for (int axis = 0, next = 0; axis < n; ++axis)
            if (has_axis(set, static_cast<std::size_t>(axis))) columns.col(next++) = v.col(axis);
        if (Eigen::JacobiSVD<Eigen::MatrixXd>(columns).singularValues()(k - 1) < 1e-9) return false;
    }
    return true;
}

unsigned largest_independent(const Axes& axes)
{
    const AxisMatrix v = ParitySpace(axes).basis();
    int k = 0;
    while (every_columns_independent(v, k + 1)) ++k;
    return static_cast<unsigned>(k);
}

TEST(Redundancy, follows_the_definition_on_every_layout_of_up_to_twelve_axes)
{
    for (const char* name : {"orthogonal-3",
                             "orthogonal-3-plus-1",
                             "cone-4",
                             "cone-3-axis",
                             "tetrad",
                             "tetrad-2",
                             "cone-5",
                             "cone-5-printed",
                             "cone-6",
                             "dodecahedron",
                             "octahedron-6",
                             "octahedron-8",
                             "tdof-symmetric",
                             "tdof-orthogonal",
                             "tdof-coplanar",
                             "guaranteed-cone",
                             "cone-7",
                             "cone-9",
                             "cone-axis-8",
                             "triads-2",
                             "triads-3",
                             "triads-4",
                             "two-triads:0,0,1,45",
                             "two-triads:1,1,1,60"}) {
        const auto axes = layout(name)->axes;
        const unsigned expected = largest_independent(axes);
        EXPECT_EQ(detectable_with(axes), expected) << name;
        EXPECT_EQ(isolable_with(axes), expected / 2) << name;
    }
}

TEST(Redundancy, follows_the_definition_on_random_axes_with_planes_and_duplicates)
{
    constexpr unsigned seed = 11;
    SCOPED_TRACE(testing::Message() << "seed " << seed);
    std::mt19937 generator(seed);
    std::uniform_int_distribution<int> grid(-1, 1), count(4, 9);
    int checked = 0;
    while (checked < 200) {
        Axes axes(count(generator), 3);
        for (Eigen::Index axis = 0; axis < axes.rows(); ++axis) {
            do axes.row(axis) = Eigen::RowVector3d(grid(generator), grid(generator), grid(generator));
            while (axes.row(axis).isZero());
            axes.row(axis).normalize();
        }
        if (rank_of(axes) < 3) continue;
        ++checked;
        EXPECT_EQ(detectable_with(axes), largest_independent(axes)) << axes;
    }
}

TEST(Redundancy, needs_five_axes_to_isolate_one_fault_and_seven_to_isolate_two)
{
    EXPECT_EQ(isolable_with(layout("cone-4")->axes), 0U);
    EXPECT_EQ(isolable_with(layout("cone-5")->axes), 1U);
    EXPECT_EQ(isolable_with(layout("cone-6")->axes), 1U);
    EXPECT_EQ(isolable_with(layout("cone-7")->axes), 2U);
    EXPECT_EQ(isolable_with(layout("cone-24")->axes), 10U);
}

TEST(Redundancy, counts_what_is_left_when_axes_are_excluded)
{
    const auto axes = layout("dodecahedron")->axes;
    EXPECT_EQ(detectable_with(axes), 3U);
    EXPECT_EQ(detectable_with(axes, 0b011111), 2U);
    EXPECT_EQ(detectable_with(axes, 0b001111), 1U);
    EXPECT_EQ(detectable_with(axes, 0b000111), 0U);
    EXPECT_EQ(detectable_with(axes, 0b000011), 0U);
    EXPECT_EQ(detectable_with(axes, 0), 0U);
}

TEST(Redundancy, counts_instruments_where_a_fault_takes_one_whole)
{
    const auto eight = layout("triads-8").value();
    EXPECT_EQ(detectable_instruments_with(eight.axes, eight.instrument), 7U);
    EXPECT_EQ(isolable_instruments_with(eight.axes, eight.instrument), 3U);
    EXPECT_EQ(detectable_with(eight.axes), 7U);

    const auto coplanar = layout("tdof-coplanar").value();
    EXPECT_EQ(detectable_instruments_with(coplanar.axes, coplanar.instrument), 2U);
    EXPECT_EQ(isolable_instruments_with(coplanar.axes, coplanar.instrument), 1U);
}

TEST(Redundancy, isolates_no_whole_instrument_of_two)
{
    const auto pair = layout("two-triads:1,1,1,60").value();
    EXPECT_EQ(detectable_instruments_with(pair.axes, pair.instrument), 1U);
    EXPECT_EQ(isolable_instruments_with(pair.axes, pair.instrument), 0U);
    EXPECT_EQ(isolable_with(pair.axes), 1U);
}

TEST(Rank, counts_the_dimensions_of_the_axes_in_use)
{
    const auto axes = layout("triads-2")->axes;
    EXPECT_EQ(rank_of(axes), 3);
    EXPECT_EQ(rank_of(axes, 0b011011), 2);
    EXPECT_EQ(rank_of(axes, 0b001001), 1);
    EXPECT_EQ(rank_of(axes, 0), 0);
}

}  // namespace
}  // namespace quorient::geometry
