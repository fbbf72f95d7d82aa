#include "quorient/geometry/figures.hpp"

#include "quorient/geometry/layouts.hpp"

#include <gtest/gtest.h>
#include <Eigen/LU>
#include <cmath>
#include <numbers>

namespace quorient::geometry {
namespace {

Axes axes_of(const char* name)
{
    return layout(name)->axes;
}

AxisMask without(std::initializer_list<std::size_t> removed)
{
    AxisMask used = ~AxisMask{0};
    for (const std::size_t axis : removed) used &= ~axis_bit(axis);
    return used;
}

void expect_accuracy(const std::optional<Accuracy>& found, const Eigen::Vector3d& eigenvalues, double trace, double volume,
                     double condition)
{
    ASSERT_TRUE(found);
    EXPECT_LT((found->eigenvalues - eigenvalues).norm(), 1e-12) << found->eigenvalues.transpose();
    EXPECT_NEAR(found->trace, trace, 1e-12);
    EXPECT_NEAR(found->volume, volume, 1e-12);
    EXPECT_NEAR(found->condition, condition, 1e-12);
}

TEST(Accuracy, of_every_optimal_six_is_that_of_a_sphere_and_of_any_five_of_them_an_ellipsoid)
{
    for (const char* name : {"cone-6", "dodecahedron", "two-triads:1,2,3,17"}) {
        expect_accuracy(accuracy(axes_of(name)), {.5, .5, .5}, 1.5, std::sqrt(.125), 1);
        for (std::size_t axis = 0; axis < 6; ++axis) expect_accuracy(accuracy(axes_of(name), without({axis})), {1, .5, .5}, 2, .5, 2);
    }
}

/// lambda_3 is printed 2; it must be 1/2, as the printed trace 3 = 1.809 + 0.691 + 0.5 shows.
TEST(Accuracy, of_the_dodecahedron_without_any_two_is_the_papers)
{
    const double r5 = std::sqrt(5.0);
    const Eigen::Vector3d eigenvalues((5 + r5) / 4, (5 - r5) / 4, .5);
    for (std::size_t i = 0; i < 6; ++i)
        for (std::size_t j = i + 1; j < 6; ++j)
            expect_accuracy(accuracy(axes_of("dodecahedron"), without({i, j})), eigenvalues, 3, std::sqrt(.625), (5 + r5) / 2);
}

TEST(Accuracy, of_the_cone_without_two_depends_on_how_far_apart_they_are)
{
    const auto axes = axes_of("cone-6");
    for (std::size_t k = 0; k < 6; ++k) {
        expect_accuracy(accuracy(axes, without({k, (k + 1) % 6})), {3, .6, .5}, 4.1, std::sqrt(.9), 6);
        expect_accuracy(accuracy(axes, without({k, (k + 2) % 6})), {1, 1, .5}, 2.5, std::sqrt(.5), 2);
        expect_accuracy(accuracy(axes, without({k, (k + 3) % 6})), {1.5, .75, .5}, 2.75, .75, 3);
    }
}

/// The printed mean .802 of the volumes weighs the three classes equally; over the fifteen pairs, as for the two other columns, it is
/// .8123.
TEST(Accuracy, of_the_cone_without_two_has_the_mean_of_fifteen_pairs)
{
    double trace = 0, volume = 0, condition = 0;
    for (std::size_t i = 0; i < 6; ++i)
        for (std::size_t j = i + 1; j < 6; ++j) {
            const auto figures = accuracy(axes_of("cone-6"), without({i, j}));
            trace += figures->trace / 15, volume += figures->volume / 15, condition += figures->condition / 15;
        }
    EXPECT_NEAR(trace, 3.19, 1e-12);
    EXPECT_NEAR(volume, .8123, 5e-5);
    EXPECT_NEAR(condition, 3.8, 1e-12);
}

TEST(Accuracy, is_undefined_where_the_axes_left_do_not_span_space)
{
    EXPECT_FALSE(accuracy(axes_of("cone-4"), 0b0011));
    EXPECT_FALSE(accuracy(axes_of("triads-2"), 0b011011));
    EXPECT_TRUE(accuracy(axes_of("triads-2"), 0b111));
}

double degrees(const char* name)
{
    return minimum_angle_rad(axes_of(name)).value() * 180 / std::numbers::pi;
}

TEST(MinimumAngle, is_the_papers)
{
    const double every_pair = std::acos(1 / std::sqrt(5.0)) * 180 / std::numbers::pi;  // 63.4349
    for (const char* name : {"dodecahedron", "dodecahedron-h1", "dodecahedron-h2", "cone-axis-6"})
        EXPECT_NEAR(degrees(name), every_pair, 1e-12);
    EXPECT_NEAR(degrees("two-cones:52.6226,10.8123,60"), every_pair, 1e-4);
    const double neighbours = std::acos(2.0 / 3) * 180 / std::numbers::pi;  // 48.19
    for (const char* name : {"cone-6", "guaranteed-cone", "two-triads:1,1,1,60", "two-triads:1,1,1,180"})
        EXPECT_NEAR(degrees(name), neighbours, 1e-12);
}

TEST(MinimumAngle, takes_axes_as_lines)
{
    EXPECT_EQ(degrees("triads-2"), 0);
    EXPECT_NEAR(degrees("orthogonal-3"), 90, 1e-12);
    EXPECT_NEAR(degrees("cone-3-axis"), std::acos(1.0 / 3) * 180 / std::numbers::pi, 1e-12);
    EXPECT_FALSE(minimum_angle_rad(axes_of("cone-4"), 0b1));
}

/// Paper 004, Table 4 (H4 undefined: the paper writes 0), and what the rounded or truncated figures stand for.
TEST(FaultMerit, reproduces_table_4)
{
    struct Row {
        const char* name;
        double f_d2, f_d1;
    };
    const double h8 = 25 / std::pow(1 + std::sqrt(3.0), 2), pentad = 1 / std::pow(std::cos(std::numbers::pi / 5), 2);
    for (const Row& row :
         {Row{"dodecahedron-h1", 5, .5}, Row{"dodecahedron-h2", 5, .5}, Row{"octahedron-6", 4, .5}, Row{"tetrad", 1, .25},
          Row{"tetrad-2", 1, .25}, Row{"cone-5", pentad, .4}, Row{"octahedron-8", h8, .625}, Row{"tdof-symmetric", h8, .625},
          Row{"tdof-orthogonal", 1.96, 7.0 / 12}, Row{"tdof-coplanar", 4.2893218813, .625}}) {
        const ParitySpace space(axes_of(row.name));
        EXPECT_NEAR(f_d2(space), row.f_d2, 1e-9) << row.name;
        EXPECT_NEAR(f_d1(space), row.f_d1, 1e-12) << row.name;
    }
    EXPECT_TRUE(std::isnan(f_d2(ParitySpace(axes_of("orthogonal-3")))));
    EXPECT_TRUE(std::isnan(f_d1(ParitySpace(axes_of("orthogonal-3")))));
}

TEST(FaultMerit, of_eight_in_an_octahedron_is_the_exact_ratio)
{
    EXPECT_NEAR(f_d2(ParitySpace(axes_of("octahedron-8"))), 3.3494, 5e-5);  // printed 3.36, the ratio of rounded figures
    EXPECT_NEAR(f_d2(ParitySpace(axes_of("tdof-symmetric"))), f_d2(ParitySpace(axes_of("octahedron-8"))), 1e-12);
}

TEST(FaultMerit, with_the_partner_axis_left_out_is_the_papers_for_two_axis_gyros)
{
    const auto merit = [](const char* name) {
        const auto cluster = layout(name).value();
        return f_d2_partner_excluded(cluster.axes, cluster.instrument);
    };
    EXPECT_NEAR(merit("tdof-symmetric").value(), 3.3494, 5e-5);
    EXPECT_NEAR(merit("tdof-orthogonal").value(), 16.0 / 9, 1e-12);
    EXPECT_NEAR(merit("tdof-coplanar").value(), 3.6951, 5e-5);
    EXPECT_FALSE(merit("octahedron-8"));
}

AxisMatrix two_axis_equations(const char* name)
{
    const auto cluster = layout(name).value();
    return parity_equations_without_partners(cluster.axes, cluster.instrument);
}

/// Paper 004, Table 1; p1's last entry is printed without its minus (a sum over the equal z of H9 must vanish).
TEST(ParityEquations, without_partners_are_those_of_table_1)
{
    const AxisMatrix v = two_axis_equations("tdof-symmetric");
    AxisVector p1(8);
    p1 << 1, 0, -.2, .1464, .2, -.4, -.2, -.5464;
    EXPECT_LT((v.row(0).transpose() - p1).cwiseAbs().maxCoeff(), 5.1e-5) << v.row(0);
    AxisVector j8(8);
    j8 << .187, .025, .1, .025, .013, .025, 0, .625;
    EXPECT_LT((isolation_index(v).row(7).transpose() - j8).cwiseAbs().maxCoeff(), 6e-4) << isolation_index(v).row(7);
}

/// Table 2 with p6's .1523 corrected to .1429 and p8's J .0298, .0583 to .2976, .5833 (lost digits).
TEST(ParityEquations, without_partners_are_those_of_table_2_corrected)
{
    const AxisMatrix v = two_axis_equations("tdof-orthogonal"), j = isolation_index(v);
    AxisMatrix expected(4, 8);
    expected << 1, 0, 0, 0, -.5, 0, -.5, 0,          //
        0, 1, -.3536, -.3536, 0, -.3536, 0, -.3536,  //
        0, .3536, 1, 0, 0, -.75, 0, .25,             //
        0, .4041, -.7143, .1429, 0, 1, 0, .1429;
    for (int row = 0; row < 4; ++row) {
        const Eigen::Index equation = row == 3 ? 5 : row;
        EXPECT_LT((v.row(equation).cwiseAbs() - expected.row(row).cwiseAbs()).cwiseAbs().maxCoeff(), 5.1e-5) << v.row(equation);
    }
    EXPECT_NEAR(j(7, 3), .2976, 5e-5);
    EXPECT_NEAR(j(7, 7), .5833, 5e-5);
    EXPECT_NEAR(j(7, 7) / j(7, 3), 1.96, 1e-12);
}

/// Table 3 needs the corrected axis 7 of H11.
TEST(ParityEquations, without_partners_are_those_of_table_3)
{
    const AxisMatrix v = two_axis_equations("tdof-coplanar");
    AxisVector p1(8), p8(8);
    p1 << 1, 0, -.1667, -.1667, -.5202, .1869, .1869, -.5202;
    p8 << -.5202, .1869, .1869, -.5202, -.1667, -.1667, 0, 1;
    EXPECT_LT((v.row(0).transpose() - p1).cwiseAbs().maxCoeff(), 5.1e-5) << v.row(0);
    EXPECT_LT((v.row(7).transpose() - p8).cwiseAbs().maxCoeff(), 5.1e-5) << v.row(7);
}

/// Row i of eq. (33), by its own least squares: 1 at i, -H_r (H_r'H_r)^-1 h_i elsewhere.
AxisVector least_squares_of_others(const Axes& axes, Eigen::Index i)
{
    Eigen::MatrixXd others = axes;
    others.row(i).setZero();
    AxisVector equation = -others * (others.transpose() * others).inverse() * axes.row(i).transpose();
    equation(i) = 1;
    return equation;
}

TEST(ParityEquations, predict_each_axis_from_the_others)
{
    for (const char* name : {"dodecahedron", "cone-5", "tdof-coplanar"}) {
        const auto axes = axes_of(name);
        const AxisMatrix v = parity_equations(ParitySpace(axes));
        EXPECT_LT((v * axes).norm(), 1e-13);
        for (Eigen::Index i = 0; i < axes.rows(); ++i) {
            EXPECT_LT((v.row(i).transpose() - least_squares_of_others(axes, i)).norm(), 1e-13) << name << " axis " << i;
        }
    }
}

TEST(ParityEquations, are_undefined_for_an_axis_that_the_others_cannot_predict)
{
    Axes axes(4, 3);
    axes << Eigen::Matrix3d::Identity(), 0, 0, 1;
    const ParitySpace space(axes);
    const AxisMatrix v = parity_equations(space);
    EXPECT_TRUE(v.topRows(2).array().isNaN().all());
    EXPECT_EQ(v(2, 2), 1);
    EXPECT_NEAR(v(2, 3), -1, 1e-15);
    EXPECT_TRUE(std::isnan(f_d2(space)));
    EXPECT_EQ(f_d1(space), 0);
}

TEST(DetectionIndex, sums_to_the_redundancy)
{
    for (const char* name : {"cone-4", "cone-5-printed", "tdof-orthogonal", "triads-8"}) {
        const ParitySpace space(axes_of(name));
        EXPECT_NEAR(detection_index(space).sum(), static_cast<double>(space.redundancy()), 1e-12) << name;
    }
}

/// 1e-11: where neighbouring axes almost coincide (cone-24) the triangular form divides by small pivots.
void expect_potter_form(const char* name)
{
    SCOPED_TRACE(name);
    const auto axes = axes_of(name);
    const ParitySpace space(axes);
    const AxisMatrix v = parity_matrix(space);
    ASSERT_EQ(v.rows(), axes.rows() - 3);
    EXPECT_LT((v * axes).norm(), 1e-11);
    EXPECT_LT((v.transpose() * v - space.projector()).norm(), 1e-11);
    EXPECT_TRUE((v * v.transpose()).isIdentity(1e-11));
    for (Eigen::Index row = 0; row < v.rows(); ++row) EXPECT_TRUE(v.row(row).head(row).isZero(0)) << "not triangular";
}

TEST(ParityMatrix, is_triangular_orthonormal_and_blind_to_motion_also_where_pivots_are_zero)
{
    for (const CatalogueEntry& entry : catalogue())
        if (const auto cluster = layout(entry.name)) expect_potter_form(entry.name.c_str());
    for (const char* name : {"triads-2", "triads-8", "cone-7", "cone-24", "two-triads:0,0,1,90"}) expect_potter_form(name);
}

TEST(ParityMatrix, skips_the_zero_pivots_of_axes_that_the_others_cannot_predict)
{
    Axes axes(5, 3);
    axes << 1, 0, 0, 0, 1, 0, 0, 1, 0, 0, 0, 1, 0, 0, -1;
    AxisMatrix expected(2, 5);
    expected << 0, 1, -1, 0, 0, 0, 0, 0, 1, 1;
    EXPECT_LT((parity_matrix(ParitySpace(axes)) - expected / std::sqrt(2.0)).norm(), 1e-14);
}

/// V2 as printed, save the last entry of row 1: + .31623 (printed -, which does not annihilate H). V1 is printed with these numbers too.
TEST(ParityMatrix, of_h2_is_the_printed_one_with_one_sign_corrected)
{
    AxisMatrix printed(3, 6);
    printed << .70711, -.31623, -.31623, -.31623, -.31623, .31623,  //
        0, .63246, .19544, .19544, -.51167, .51167,                 //
        0, 0, .60150, -.60150, -.37175, -.37175;
    EXPECT_LT((parity_matrix(ParitySpace(axes_of("dodecahedron-h2"))) - printed).cwiseAbs().maxCoeff(), 1.5e-5);
}

/// V8 save two entries of the last column that are printed -.158 and .693 and do not annihilate H8.
TEST(ParityMatrix, of_h7_and_h8_are_the_printed_ones_with_two_entries_corrected)
{
    AxisMatrix h7(2, 5), h8(5, 8);
    h7 << .63245, .51167, .19543, .19543, .51167, 0, .37175, .60150, -.60150, -.37175;
    h8 << .79057, 0, -.15811, .43198, .15811, .31623, -.15811, -.11575,  //
        0, .79057, -.11575, -.15811, .31623, .15811, .43198, -.158,      //
        0, 0, .76590, .06528, -.08278, .53507, .19585, .278,             //
        0, 0, 0, .63964, -.16322, -.42451, .58442, .206,                 //
        0, 0, 0, 0, .68301, -.18301, -.18301, .68301;
    EXPECT_LT((parity_matrix(ParitySpace(axes_of("cone-5"))) - h7).cwiseAbs().maxCoeff(), 2e-5);
    EXPECT_LT((parity_matrix(ParitySpace(axes_of("octahedron-8"))) - h8).cwiseAbs().maxCoeff(), 7e-4);
}

/// V10 as corrected in the errata: its rows annihilate H10, the printed ones do not.
TEST(ParityMatrix, of_h10_spans_the_corrected_printed_rows)
{
    const double r2 = std::sqrt(2.0);
    AxisMatrix corrected(5, 8), printed_row(1, 8);
    corrected << 1, 0, 0, 0, -1, 0, 0, 0,  //
        1, 0, 0, 0, 0, 0, -1, 0,           //
        0, 0, 1, 0, 0, -1, 0, 0,           //
        0, 0, 0, -1, 0, 0, 0, 1,           //
        0, r2, 1, 1, 0, 0, 0, 0;
    corrected /= r2;
    printed_row << .707, 0, -.707, 0, 0, 0, 0, 0;
    const auto axes = axes_of("tdof-orthogonal");
    EXPECT_LT((corrected * axes).norm(), 1e-14);
    EXPECT_GT((printed_row * axes).norm(), .5);
    const AxisMatrix projector = ParitySpace(axes).projector();
    EXPECT_LT((corrected * projector - corrected).norm(), 1e-14);
}

}  // namespace
}  // namespace quorient::geometry
