#include "quorient/geometry/parity_space.hpp"

#include "allocation_count.hpp"

#include "quorient/geometry/layouts.hpp"
#include "quorient/geometry/redundancy.hpp"
#include "quorient/geometry/triads.hpp"

#include <gtest/gtest.h>
#include <Eigen/LU>
#include <cmath>
#include <limits>
#include <random>

namespace quorient::geometry {
namespace {

const Eigen::Vector3d rate_rad_s(0.3, -1.2, 2.5);

class OnEveryLayout : public testing::TestWithParam<const char*> {
protected:
    const Axes axes = layout(GetParam()).value().axes;
};

INSTANTIATE_TEST_SUITE_P(ParitySpace, OnEveryLayout,
                         testing::Values("orthogonal-3-plus-1", "cone-4", "cone-3-axis", "cone-5", "cone-5-printed", "cone-6",
                                         "dodecahedron", "octahedron-8", "tdof-symmetric", "tdof-orthogonal", "tdof-coplanar", "cone-7",
                                         "cone-24", "triads-4", "triads-8", "two-triads:1,1,1,60"));

TEST_P(OnEveryLayout, is_blind_to_motion)
{
    EXPECT_LT(ParitySpace(axes).vector(axes * rate_rad_s).norm(), 1e-14);
}

TEST_P(OnEveryLayout, is_an_orthonormal_basis_of_the_left_null_space)
{
    const ParitySpace space(axes);
    EXPECT_EQ(space.redundancy(), axes.rows() - 3);
    EXPECT_TRUE((space.basis() * space.basis().transpose()).isIdentity(1e-14));
    EXPECT_LT((space.basis() * axes).norm(), 1e-14);
    const AxisMatrix by_definition =
        AxisMatrix::Identity(axes.rows(), axes.rows()) - axes * (axes.transpose() * axes).inverse() * axes.transpose();
    EXPECT_LT((space.projector() - by_definition).norm(), 1e-13);
}

TEST_P(OnEveryLayout, explains_a_single_fault_wholly_by_the_faulty_axis)
{
    const ParitySpace space(axes);
    for (Eigen::Index faulty = 0; faulty < axes.rows(); ++faulty) {
        if (!space.sees(faulty)) continue;
        AxisVector z = axes * rate_rad_s;
        z(faulty) += 0.1;
        const AxisVector parity = space.vector(z);
        EXPECT_GT(parity.norm(), 1e-3);
        EXPECT_NEAR(space.explained_by(faulty, parity), parity.squaredNorm(), 1e-15);
        EXPECT_NEAR(space.fault_estimate(faulty, parity), 0.1, 1e-14);
        EXPECT_NEAR(space.residual(z)(faulty), 0.1 * space.projector()(faulty, faulty), 1e-14);
    }
}

TEST_P(OnEveryLayout, without_an_axis_equals_the_smaller_cluster)
{
    const Eigen::Index n = axes.rows();
    for (Eigen::Index removed = 0; removed < n; ++removed) {
        const ParitySpace space(axes, ~axis_bit(static_cast<std::size_t>(removed)));
        Axes fewer(n - 1, 3);
        fewer << axes.topRows(removed), axes.bottomRows(n - 1 - removed);
        const ParitySpace smaller(fewer);
        EXPECT_EQ(space.redundancy(), smaller.redundancy());
        AxisMatrix cut(n - 1, n - 1);
        const AxisMatrix& p = space.projector();
        cut << p.topLeftCorner(removed, removed), p.topRightCorner(removed, n - 1 - removed), p.bottomLeftCorner(n - 1 - removed, removed),
            p.bottomRightCorner(n - 1 - removed, n - 1 - removed);
        EXPECT_LT((cut - smaller.projector()).norm(), 1e-13);
        EXPECT_FALSE(space.sees(removed));
    }
}

TEST(ParitySpace, tells_the_faulty_axis_of_six_from_the_healthy_ones)
{
    const auto axes = layout("cone-6")->axes;
    const ParitySpace space(axes);
    for (Eigen::Index faulty = 0; faulty < 6; ++faulty) {
        AxisVector z = axes * rate_rad_s;
        z(faulty) += 0.1;
        const AxisVector parity = space.vector(z);
        for (Eigen::Index healthy = 0; healthy < 6; ++healthy) {
            if (healthy == faulty) continue;
            EXPECT_LT(space.explained_by(healthy, parity), 0.9 * parity.squaredNorm());
        }
    }
}

TEST(ParitySpace, never_reads_an_excluded_axis)
{
    const auto axes = layout("dodecahedron")->axes;
    const ParitySpace space(axes, all_axes(6) & ~axis_bit(2));
    AxisVector z = axes * rate_rad_s;
    z(2) = std::numeric_limits<double>::quiet_NaN();
    EXPECT_LT(space.vector(z).norm(), 1e-14);
    EXPECT_LT(space.residual(z).norm(), 1e-14);
    EXPECT_EQ(space.residual(z)(2), 0);
    EXPECT_EQ(space.explained_by(2, space.vector(z)), 0);
}

TEST(ParitySpace, is_empty_where_nothing_is_redundant)
{
    const auto axes = layout("cone-4")->axes;
    for (const AxisMask used : {AxisMask{0b0111}, AxisMask{0b0101}, AxisMask{0b1000}, AxisMask{0}}) {
        const ParitySpace space(axes, used);
        EXPECT_EQ(space.redundancy(), 0);
        const AxisVector z = AxisVector::Ones(4);
        EXPECT_EQ(space.vector(z).size(), 0);
        EXPECT_EQ(space.residual(z), AxisVector::Zero(4));
        EXPECT_EQ(space.explained_by(0, space.vector(z)), 0);
    }
}

TEST(ParitySpace, has_a_row_per_redundant_axis_where_the_axes_in_use_lie_in_a_plane)
{
    const auto axes = layout("triads-3")->axes;
    EXPECT_EQ(ParitySpace(axes, 0b011011011).redundancy(), 4);
    EXPECT_EQ(ParitySpace(axes, 0b001001001).redundancy(), 2);
}

TEST(ParitySpace, sees_only_axes_that_the_others_can_predict)
{
    Axes axes(4, 3);
    axes << Eigen::Matrix3d::Identity(), 0, 0, 1;
    const ParitySpace space(axes);
    EXPECT_FALSE(space.sees(0));
    EXPECT_FALSE(space.sees(1));
    EXPECT_TRUE(space.sees(2));
    EXPECT_TRUE(space.sees(3));
}

TEST(ParitySpace, keeps_its_accuracy_when_two_axes_almost_coincide)
{
    Axes axes = layout("cone-6")->axes;
    axes.row(1) = (axes.row(0) + 1e-5 * axes.row(2)).normalized();
    const ParitySpace space(axes);
    EXPECT_LT((space.basis() * axes).norm(), 1e-14);
    EXPECT_TRUE((space.basis() * space.basis().transpose()).isIdentity(1e-14));
}

TEST(ParitySpace, sees_noise_with_the_energy_of_its_degrees_of_freedom)
{
    constexpr unsigned seed = 7;
    SCOPED_TRACE(testing::Message() << "seed " << seed);
    std::mt19937 generator(seed);
    std::normal_distribution<double> noise;
    const ParitySpace space(layout("cone-6")->axes);
    double energy = 0;
    constexpr int trials = 20000;
    for (int trial = 0; trial < trials; ++trial) {
        AxisVector z(6);
        for (double& value : z) value = noise(generator);
        energy += space.vector(z).squaredNorm();
    }
    EXPECT_NEAR(energy / trials, 3, 5 * std::sqrt(6.0 / trials));
}

TEST(ParitySpace, allocates_nothing_to_be_built_or_used)
{
    const auto axes = layout("triads-8")->axes;
    const AxisVector z = AxisVector::LinSpaced(24, -1, 1);
    const std::size_t before = test::allocation_count();
    double sum = 0;
    for (std::size_t excluded = 0; excluded < 24; ++excluded) {
        const AxisMask used = ~axis_bit(excluded);
        const ParitySpace space(axes, used);
        const AxisVector parity = space.vector(z);
        sum += space.residual(z).norm() + space.explained_by(3, parity) + detectable_with(axes, used);
        sum += triad_inverse(axes, {0, 4, 8})->condition + least_squares_inverse(axes, used)->norm();
    }
    EXPECT_EQ(test::allocation_count(), before);
    EXPECT_GT(sum, 0);

    const Eigen::VectorXd on_the_heap = z;
    EXPECT_EQ(test::allocation_count(), before + 1) << "the counter does not count " << on_the_heap.size();
}

}  // namespace
}  // namespace quorient::geometry
