#include "quorient/rotation/euler.hpp"

#include <gtest/gtest.h>
#include <limits>
#include <numbers>
#include <random>

namespace quorient::rotation {
namespace {

Eigen::Vector3d random_vector(std::mt19937_64& random, double norm)
{
    std::normal_distribution<double> normal;
    return Eigen::Vector3d(normal(random), normal(random), normal(random)).normalized() * norm;
}

TEST(Rotation, of_a_vector_is_the_matrix_exponential)
{
    std::mt19937_64 random(1);
    for (const double angle : {1e-9, 1e-4, 9.99e-4, 1.01e-3, 0.5, 3.0}) {
        const Eigen::Vector3d phi = random_vector(random, angle);
        const Eigen::Matrix3d expected = Eigen::AngleAxisd(angle, phi.normalized()).toRotationMatrix();
        EXPECT_LT((from_rotation_vector(phi).toRotationMatrix() - expected).norm(), 1e-14) << angle;
    }
}

TEST(Rotation, comes_back_as_the_vector_it_was_made_from)
{
    std::mt19937_64 random(2);
    for (const double angle : {1e-15, 1e-8, 1e-3, 1.0, 3.1}) {
        const Eigen::Vector3d phi = random_vector(random, angle);
        EXPECT_LT((to_rotation_vector(from_rotation_vector(phi)) - phi).norm(), 1e-14 * (1 + angle)) << angle;
    }
    const Quaternion opposite(-1 + 1e-18, 0, 0, 0);
    EXPECT_EQ(to_rotation_vector(opposite).norm(), 0);
}

TEST(Rotation, angles_are_accurate_where_the_cosine_is_flat)
{
    std::mt19937_64 random(3);
    const Quaternion start = from_rotation_vector(random_vector(random, 1.2));
    for (const double angle : {1e-12, 1e-9, 1e-3, 1.0}) {
        const Quaternion turned = start * from_rotation_vector(random_vector(random, angle));
        EXPECT_NEAR(angle_between(start, turned), angle, 4e-16 + 1e-12 * angle);
        EXPECT_NEAR(angle_between(to_array(start), to_array(turned)), angle, 4e-16 + 1e-12 * angle);
    }
}

TEST(Rotation, of_more_than_half_a_turn_is_the_short_way_round)
{
    EXPECT_NEAR(angle_of(from_rotation_vector({0, 0, 4.0})), 2 * std::numbers::pi - 4.0, 1e-12);
}

TEST(Rotation, products_on_the_wire_are_those_of_the_quaternions)
{
    const Wxyz quarter_z = to_array(from_rotation_vector({0, 0, std::numbers::pi / 2}));
    const Wxyz half_z = product(quarter_z, quarter_z);
    EXPECT_NEAR(half_z[0], 0, 1e-15);
    EXPECT_NEAR(half_z[3], 1, 1e-15);
    EXPECT_NEAR(angle_of(product(half_z, conjugate(half_z))), 0, 1e-15);
}

TEST(Attitude, is_finite_and_of_unit_norm)
{
    EXPECT_TRUE(is_attitude({1, 0, 0, 0}));
    EXPECT_TRUE(is_attitude({0.6, 0, 0.8, 1e-7}));
    EXPECT_FALSE(is_attitude({1, 0, 0, 0.01}));
    EXPECT_FALSE(is_attitude({0, 0, 0, 0}));
    EXPECT_FALSE(is_attitude({std::numeric_limits<double>::quiet_NaN(), 0, 0, 1}));
    EXPECT_FALSE(is_attitude({std::numeric_limits<double>::infinity(), 0, 0, 0}));
}

TEST(RollPitchYaw, turns_the_body_by_yaw_first_then_pitch_then_roll)
{
    const std::array<double, 3> angles{0.3, -0.7, 2.1};
    const Eigen::Matrix3d turned = (Eigen::AngleAxisd(angles[2], Eigen::Vector3d::UnitZ()) * Eigen::AngleAxisd(angles[1], Eigen::Vector3d::UnitY()) *
                                    Eigen::AngleAxisd(angles[0], Eigen::Vector3d::UnitX()))
                                       .toRotationMatrix();
    const auto found = roll_pitch_yaw(to_array(Quaternion(turned)));
    for (std::size_t i = 0; i < 3; ++i) EXPECT_NEAR(found[i], angles[i], 1e-14) << i;
}

}  // namespace
}  // namespace quorient::rotation
