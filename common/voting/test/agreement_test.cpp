#include "scene.hpp"

#include <gtest/gtest.h>
#include <limits>
#include <numbers>

using namespace quorient;
using namespace quorient::voting;
using namespace quorient::voting::test;

TEST(Agreement, measures_the_shortest_rotation_whatever_the_sign_of_the_quaternion)
{
    for (const double angle : {0.0, 1e-12, 1e-8, 1e-4, 0.5, 3.0}) {
        const Quaternion a = truth(17);
        Quaternion b = product(turn(angle, 0), a);
        EXPECT_NEAR(angle_between(a, b), angle, 1e-15 + 1e-12 * angle);
        for (double& part : b) part = -part;
        EXPECT_NEAR(angle_between(a, b), angle, 1e-15 + 1e-12 * angle);
    }
    EXPECT_NEAR(angle_between(no_rotation, turn(4.0)), 2 * std::numbers::pi - 4.0, 1e-12);
}

TEST(Agreement, follows_the_hamilton_product)
{
    const Quaternion i{0, 1, 0, 0}, j{0, 0, 1, 0}, k{0, 0, 0, 1};
    EXPECT_EQ(product(i, j), k);
    EXPECT_NEAR(angle_between(product(truth(3), conjugate(truth(3))), no_rotation), 0, 1e-15);
}

TEST(Agreement, accepts_only_finite_unit_quaternions)
{
    EXPECT_TRUE(is_attitude(truth(5)));
    EXPECT_FALSE(is_attitude({0, 0, 0, 0}));
    EXPECT_FALSE(is_attitude({1.001, 0, 0, 0}));
    EXPECT_FALSE(is_attitude({std::numeric_limits<double>::quiet_NaN(), 0, 0, 1}));
    EXPECT_FALSE(is_attitude({std::numeric_limits<double>::infinity(), 0, 0, 0}));
}

TEST(Agreement, gate_is_the_floor_plus_the_sigmas_of_both)
{
    const Agreement agreement(1e-4, 5);
    const double gate = 1e-4 + 5 * std::sqrt(2.0) * 1e-5;
    EXPECT_TRUE(agreement.agree(0, sample_of(0, 4), 1, moved(sample_of(1, 4), 0.999 * gate), 1));
    EXPECT_FALSE(agreement.agree(0, sample_of(0, 4), 1, moved(sample_of(1, 4), 1.001 * gate), 1));
}

TEST(Agreement, is_harder_to_regain_than_to_keep)
{
    Agreement agreement(1e-4, 5);
    const auto near_gate = moved(sample_of(1, 4), 1.2e-4);
    EXPECT_TRUE(agreement.agree(0, sample_of(0, 4), 1, near_gate, 1));

    agreement.remember(0, sample_of(0, 4), 1, moved(sample_of(1, 4), 1e-3), 1);
    EXPECT_FALSE(agreement.agree(0, sample_of(0, 4), 1, near_gate, 1));
    EXPECT_FALSE(agreement.agree(1, near_gate, 0, sample_of(0, 4), 1)) << "the order of the pair does not matter";
    EXPECT_TRUE(agreement.agree(0, sample_of(0, 4), 1, moved(sample_of(1, 4), 0.5e-4), 1));

    agreement.forget(1);
    EXPECT_TRUE(agreement.agree(0, sample_of(0, 4), 1, near_gate, 1));
}

TEST(Agreement, is_not_widened_by_one_lane_that_claims_a_large_sigma)
{
    const Agreement agreement(1e-4, 5);
    AttitudeState boaster = moved(sample_of(1, 4), 0.01);
    boaster.angle_sigma_rad = 1.0;
    EXPECT_FALSE(agreement.agree(0, sample_of(0, 4), 1, boaster, 1e-5));
    EXPECT_TRUE(agreement.agree(0, sample_of(0, 4), 1, boaster, 1.0)) << "with the limit gone, the same pair agrees";
}
