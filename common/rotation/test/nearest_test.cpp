#include "quorient/rotation/nearest.hpp"

#include <Eigen/Geometry>
#include <gtest/gtest.h>
#include <random>

namespace quorient::rotation {
namespace {

Eigen::Matrix3d random_rotation(std::mt19937_64& random)
{
    std::normal_distribution<double> normal;
    return Eigen::Quaterniond(normal(random), normal(random), normal(random), normal(random)).normalized().toRotationMatrix();
}

/// U diag(1, 1/2, 1/4) V' of two random rotations: what is nearest to it is U V'.
struct Stretched {
    Eigen::Matrix3d u, v, matrix;

    explicit Stretched(std::mt19937_64& random, double third = 0.25)
        : u(random_rotation(random)), v(random_rotation(random)), matrix(u * Eigen::Vector3d(1, 0.5, third).asDiagonal() * v.transpose())
    {
    }
};

TEST(Nearest, rotation_of_a_stretched_one_is_that_rotation)
{
    std::mt19937_64 random(1);
    for (int i = 0; i < 100; ++i) {
        const Stretched stretched(random);
        const Eigen::Matrix3d truth = stretched.u * stretched.v.transpose();
        EXPECT_LT((nearest_rotation(stretched.matrix) - truth).norm(), 1e-13);
        EXPECT_LT((nearest_orthogonal(stretched.matrix) - truth).norm(), 1e-13);
    }
}

TEST(Nearest, to_a_reflection_one_is_a_reflection_and_the_other_turns_over_the_weakest_direction)
{
    std::mt19937_64 random(2);
    for (int i = 0; i < 100; ++i) {
        const Stretched stretched(random, -0.25);
        const Eigen::Matrix3d turned_over = stretched.u * Eigen::Vector3d(1, 1, -1).asDiagonal() * stretched.v.transpose();
        EXPECT_LT((nearest_orthogonal(stretched.matrix) - turned_over).norm(), 1e-13);
        EXPECT_LT((nearest_rotation(stretched.matrix) - stretched.u * stretched.v.transpose()).norm(), 1e-13);
    }
}

TEST(Nearest, rotation_is_closer_than_its_neighbours)
{
    std::mt19937_64 random(3);
    std::normal_distribution<double> normal;
    for (int i = 0; i < 100; ++i) {
        const Eigen::Matrix3d m = Eigen::Matrix3d::NullaryExpr([&] { return normal(random); });
        const Eigen::Matrix3d nearest = nearest_rotation(m);
        ASSERT_GT(nearest.determinant(), 0);
        for (int axis = 0; axis < 3; ++axis)
            for (const double angle : {-1e-3, 1e-3}) {
                const Eigen::Matrix3d neighbour = nearest * Eigen::AngleAxisd(angle, Eigen::Vector3d::Unit(axis)).toRotationMatrix();
                EXPECT_LE((m - nearest).norm(), (m - neighbour).norm());
            }
    }
}

TEST(Nearest, singular_values_tell_one_direction_from_two)
{
    const Eigen::Vector3d line(1, 2, 3);
    const Eigen::Vector3d one = singular_values(line * line.transpose());
    EXPECT_NEAR(one(0), 14, 1e-12);
    EXPECT_NEAR(one(1), 0, 1e-12);
    const Eigen::Vector3d two = singular_values(Eigen::Vector3d(3, 2, 0).asDiagonal().toDenseMatrix());
    EXPECT_NEAR(two(1), 2, 1e-12);
}

}  // namespace
}  // namespace quorient::rotation
