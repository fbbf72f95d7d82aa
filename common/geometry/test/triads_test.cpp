#include "quorient/geometry/triads.hpp"

#include "quorient/geometry/layouts.hpp"
#include "quorient/geometry/redundancy.hpp"

#include <gtest/gtest.h>
#include <cmath>

/// Paper 003, equations 12-34, each with its misprints corrected and the reason. Triads T1..T4 = axes 012, 013, 023, 123.
namespace quorient::geometry {
namespace {

const double r2 = std::sqrt(2.0), r3 = std::sqrt(3.0), r6 = std::sqrt(6.0);

Eigen::Matrix3d matrix(std::initializer_list<double> entries)
{
    Eigen::Matrix3d m;
    auto entry = entries.begin();
    for (Eigen::Index k = 0; k < 9; ++k) m(k / 3, k % 3) = *entry++;
    return m;
}

void expect_triads(const char* layout_name, const std::array<Eigen::Matrix3d, 4>& expected)
{
    const auto found = triads(layout(layout_name)->axes);
    ASSERT_EQ(found.size(), 4U);
    const std::array<AxisMask, 4> masks{0b0111, 0b1011, 0b1101, 0b1110};
    for (std::size_t k = 0; k < 4; ++k) {
        EXPECT_EQ(found[k].mask(), masks[k]);
        EXPECT_LT((found[k].body_from_axes - expected[k]).norm(), 1e-14) << layout_name << " T" << k + 1 << "\n" << found[k].body_from_axes;
    }
}

void expect_least_squares(const char* layout_name, const Eigen::Matrix<double, 3, 4>& expected)
{
    EXPECT_LT((*least_squares_inverse(layout(layout_name)->axes) - expected).norm(), 1e-14) << layout_name;
}

TEST(Triads, of_three_plus_one_are_equations_14_to_17)
{
    expect_triads("orthogonal-3-plus-1", {matrix({1, 0, 0, 0, 1, 0, 0, 0, 1}), matrix({1, 0, 0, 0, 1, 0, -1, -1, r3}),
                                          matrix({1, 0, 0, -1, -1, r3, 0, 1, 0}), matrix({-1, -1, r3, 1, 0, 0, 0, 1, 0})});
}

TEST(Triads, of_cone_4_are_equations_23_to_26)
{
    const double h = r3 / 2;
    expect_triads("cone-4", {matrix({h, -h, 0, 0, -h, h, h, 0, h}), matrix({h, -h, 0, -h, 0, h, 0, h, h}),
                             matrix({0, -h, h, -h, 0, h, h, h, 0}), matrix({0, -h, h, -h, h, 0, h, 0, h})});
}

/// (32) lost its fraction bars and its third row.
TEST(Triads, of_cone_3_axis_are_equations_31_to_34)
{
    expect_triads("cone-3-axis", {matrix({1 / r2, -1 / (2 * r2), -1 / (2 * r2), 0, -r6 / 4, r6 / 4, 1, 1, 1}),
                                  matrix({3 * r2 / 4, 0, -r2 / 4, -r6 / 4, -r6 / 2, r6 / 4, 0, 0, 1}),
                                  matrix({3 * r2 / 4, 0, -r2 / 4, r6 / 4, r6 / 2, -r6 / 4, 0, 0, 1}),
                                  matrix({-3 * r2 / 4, -3 * r2 / 4, r2 / 2, -r6 / 4, r6 / 4, 0, 0, 0, 1})});
}

TEST(LeastSquares, of_three_plus_one_is_equation_12)
{
    Eigen::Matrix<double, 3, 4> b;
    b << 5, -1, -1, r3, -1, 5, -1, r3, -1, -1, 5, r3;
    expect_least_squares("orthogonal-3-plus-1", b / 6);
}

/// Row 1 is printed (-, +, -, +) in (21) and (22); that matrix times H is not the identity.
TEST(LeastSquares, of_cone_4_is_equation_21_with_its_first_row_corrected)
{
    Eigen::Matrix<double, 3, 4> b, printed;
    b << 1, -1, -1, 1, -1, -1, 1, 1, 1, 1, 1, 1;
    printed << -1, 1, -1, 1, -1, -1, 1, 1, 1, 1, 1, 1;
    expect_least_squares("cone-4", b * r3 / 4);
    EXPECT_FALSE((printed * r3 / 4 * layout("cone-4")->axes).isIdentity(0.1));
}

TEST(LeastSquares, of_cone_3_axis_is_equation_30)
{
    Eigen::Matrix<double, 3, 4> b;
    b << 1 / r2, -1 / (2 * r2), -1 / (2 * r2), 0, 0, -r3 / (2 * r2), r3 / (2 * r2), 0, .25, .25, .25, .75;
    expect_least_squares("cone-3-axis", b);
}

TEST(LeastSquares, of_the_axes_in_use_ignores_the_others)
{
    const auto axes = layout("dodecahedron")->axes;
    const Eigen::Vector3d rate_rad_s(0.3, -1.2, 2.5);
    AxisVector z = axes * rate_rad_s;
    z(1) = 1e6;
    const auto b = least_squares_inverse(axes, all_axes(6) & ~axis_bit(1));
    ASSERT_TRUE(b);
    EXPECT_LT((*b * z - rate_rad_s).norm(), 1e-12);
    EXPECT_FALSE(least_squares_inverse(axes, 0b11));
}

TEST(Triads, give_the_body_vector_from_any_three_axes)
{
    const auto axes = layout("cone-7")->axes;
    const Eigen::Vector3d rate_rad_s(0.3, -1.2, 2.5);
    const AxisVector z = axes * rate_rad_s;
    for (const Triad& triad : triads(axes)) EXPECT_LT((triad.body(z) - rate_rad_s).norm(), 1e-13);
}

TEST(Triads, leave_out_axes_in_one_plane)
{
    EXPECT_EQ(triads(layout("octahedron-6")->axes).size(), 16U);  // four of the 20 lie in a face's plane
    EXPECT_EQ(triads(layout("triads-8")->axes).size(), 512U);
    EXPECT_FALSE(triad_inverse(layout("triads-2")->axes, {0, 1, 3}));
    EXPECT_TRUE(triad_inverse(layout("triads-2")->axes, {0, 1, 5}));

    Axes nearly(3, 3);
    for (const double angle_rad : {1e-7, 1e-5}) {
        nearly << 1, 0, 0, 0, 1, 0, std::cos(angle_rad), 0, std::sin(angle_rad);
        EXPECT_EQ(triad_inverse(nearly, {0, 1, 2}).has_value(), angle_rad > coplanar_tolerance);
    }
}

TEST(Triads, of_the_axes_in_use_leave_out_the_others)
{
    const auto found = triads(layout("dodecahedron")->axes, 0b101110);
    EXPECT_EQ(found.size(), 4U);
    for (const Triad& triad : found) EXPECT_EQ(triad.mask() & 0b010001U, 0U);
}

TEST(Triads, state_their_condition)
{
    EXPECT_NEAR(triad_inverse(layout("triads-1")->axes, {0, 1, 2})->condition, 1, 1e-15);
    EXPECT_NEAR(triad_inverse(layout("cone-6")->axes, {0, 2, 4})->condition, 1, 1e-14);
    EXPECT_NEAR(triad_inverse(layout("cone-4")->axes, {0, 1, 2})->condition, 2, 1e-14);  // H'H = 4/3 I - e e': 4/3 over 1/3

    Axes nearly_flat(3, 3);
    nearly_flat << 1, 0, 0, 0, 1, 0, std::cos(1e-3), 0, std::sin(1e-3);
    // singular values of two unit vectors at angle a: sqrt(1 + cos a), sqrt(1 - cos a)
    EXPECT_NEAR(triad_inverse(nearly_flat, {0, 1, 2})->condition, std::sqrt((1 + std::cos(1e-3)) / (1 - std::cos(1e-3))), 1e-5);
}

}  // namespace
}  // namespace quorient::geometry
