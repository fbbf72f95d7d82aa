#include "quorient/attitude/body_increment.hpp"

#include "quorient/attitude/levelling.hpp"
#include "scenario.hpp"

#include <gtest/gtest.h>
#include <cmath>
#include <numbers>
#include <random>

namespace quorient::attitude {
namespace {

using namespace testing;

Eigen::Vector3d applied(const BodyIncrement::Solution& solution, const geometry::AxisVector& z)
{
    return solution.gain.leftCols(z.size()) * z;
}

TEST(BodyIncrement, returns_the_turn_from_any_three_or_more_independent_axes)
{
    const Eigen::Vector3d turn(0.01, -0.02, 0.005);
    for (const auto& name : all_layouts()) {
        const auto cluster = cluster_of(name, 0.01, 1e-6);
        const BodyIncrement body(cluster);
        const geometry::AxisVector z = cluster.axes * turn;
        for (std::size_t lost = 0; lost <= cluster.size(); ++lost) {
            const AxisMask axes = cluster.all() & ~(lost < cluster.size() ? axis_bit(lost) : 0);
            const auto& solution = body.solve(axes);
            if (!solution.independent) continue;
            EXPECT_LT((applied(solution, z) - turn).norm(), 1e-15) << name << " without " << lost;
            for (std::size_t axis = 0; axis < max_axes; ++axis) {
                if (has_axis(axes, axis)) continue;
                EXPECT_EQ(solution.gain.col(static_cast<Eigen::Index>(axis)).norm(), 0) << name;
            }
        }
    }
}

TEST(BodyIncrement, refuses_fewer_than_three_independent_axes)
{
    const auto cluster = cluster_of("orthogonal-3-plus-1", 0.01);
    const BodyIncrement body(cluster);
    EXPECT_TRUE(body.solve(0b1111).independent);
    EXPECT_TRUE(body.solve(0b1110).independent);
    EXPECT_FALSE(body.solve(0b0011).independent);
    EXPECT_FALSE(body.solve(0).independent);
    EXPECT_EQ(body.solve(0b0011).gain.norm(), 0);

    const auto coplanar = cluster_of("triads-2", 0.01);  // axes 0 and 3 are the same line
    EXPECT_FALSE(BodyIncrement(coplanar).solve(0b001011).independent);
}

TEST(BodyIncrement, accepts_the_triads_that_the_condition_of_ten_was_made_for)
{
    const auto plus_1 = cluster_of("orthogonal-3-plus-1", 0.01);
    const BodyIncrement body(plus_1);
    EXPECT_NEAR(body.solve(0b1110).condition, 9.9, 0.01);
    EXPECT_TRUE(body.well_conditioned(0b1110));
    EXPECT_FALSE(body.well_conditioned(0b0110));
}

TEST(BodyIncrement, weighs_axes_by_their_noise)
{
    auto cluster = cluster_of("cone-6", 0.01, 1e-4);
    cluster.sigma(2) = 1e-2;
    const BodyIncrement body(cluster);
    const auto& with = body.solve(cluster.all());
    const auto& without = body.solve(cluster.all() & ~axis_bit(2));
    EXPECT_LT(with.gain.col(2).norm(), 1e-3);
    EXPECT_LT(with.variance, without.variance);
    EXPECT_NEAR(with.variance, without.variance, 1e-3 * without.variance);

    cluster.sigma.setConstant(1e-4);
    EXPECT_NEAR(BodyIncrement(cluster).solve(cluster.all()).variance, 1.5e-8, 1e-20);  // trace of (H'H)^-1 is 1.5 (paper 002)
}

TEST(BodyIncrement, answers_the_same_whatever_was_asked_before)
{
    const auto cluster = cluster_of("dodecahedron", 0.01, 1e-6);
    const BodyIncrement asked_often(cluster);
    std::mt19937_64 random(3);
    for (int i = 0; i < 500; ++i) {
        const auto axes = static_cast<AxisMask>(random()) & cluster.all();
        EXPECT_EQ(asked_often.solve(axes).gain, BodyIncrement(cluster).solve(axes).gain) << axes;
    }
}

TEST(Levelling, finds_roll_and_pitch_of_a_body_at_rest_and_keeps_the_heading)
{
    using Eigen::AngleAxisd;
    using Eigen::Vector3d;
    for (const double roll : {-3.0, -0.5, 0.0, 1.2})
        for (const double pitch : {-1.4, 0.0, 0.7})
            for (const double heading : {-2.0, 0.0, 1.0}) {
                const Quaternion truth(AngleAxisd(heading, Vector3d::UnitZ()) * AngleAxisd(pitch, Vector3d::UnitY()) *
                                       AngleAxisd(roll, Vector3d::UnitX()));
                const Vector3d felt = truth.conjugate() * Vector3d(0, 0, 9.81);
                const auto levelled = level(felt, heading);
                ASSERT_TRUE(levelled.has_value()) << levelled.error();
                EXPECT_LT(angle_between(*levelled, truth), 1e-14);
            }
}

TEST(Levelling, refuses_a_body_that_is_not_at_rest)
{
    EXPECT_FALSE(level({0, 0, 14}, 0).has_value());
    EXPECT_FALSE(level({0, 0, 0}, 0).has_value());
    EXPECT_FALSE(level({NAN, 0, 9.8}, 0).has_value());
    EXPECT_FALSE(level({0, 0, 9.8}, INFINITY).has_value());
    EXPECT_TRUE(level({0, 0, 9.8}, 0).has_value());
}

}  // namespace
}  // namespace quorient::attitude
