#include "files.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <cmath>

namespace quorient::system {

namespace {

using testing::HasSubstr;

constexpr double half_root = 0.70710678118654752;

std::string with_attitude(const std::string& rotation)
{
    return with(simulation_file, "layout: cone-6", "layout: cone-6, initial_attitude: " + rotation);
}

std::array<double, 4> attitude_of(const std::string& rotation)
{
    const auto system = loaded(with_attitude(rotation));
    EXPECT_TRUE(system) << system.error();
    return system ? system->sensor.initial_attitude.value_or(std::array<double, 4>{}) : std::array<double, 4>{};
}

std::string attitude_refusal(const std::string& rotation)
{
    return refusal(with_attitude(rotation));
}

void expect_near(const std::array<double, 4>& q, const std::array<double, 4>& expected, double tolerance = 1e-15)
{
    for (std::size_t i = 0; i < 4; ++i) EXPECT_NEAR(q[i], expected[i], tolerance) << "component " << i;
}

}  // namespace

TEST(Rotation, is_read_as_a_quaternion_exactly_as_it_stands)
{
    EXPECT_EQ(attitude_of("[0.6, 0, 0.8, 0]"), (std::array<double, 4>{0.6, 0, 0.8, 0}));
}

TEST(Rotation, is_read_as_rows_of_a_matrix)
{
    // A quarter turn about z takes x to y: columns are the images of the axes.
    expect_near(attitude_of("[[0, -1, 0], [1, 0, 0], [0, 0, 1]]"), {half_root, 0, 0, half_root});
    expect_near(attitude_of("[[1, 0, 0], [0, 0, -1], [0, 1, 0]]"), {half_root, half_root, 0, 0});
}

TEST(Rotation, is_read_as_roll_pitch_and_yaw_in_degrees)
{
    expect_near(attitude_of("{roll_deg: 90, pitch_deg: 0, yaw_deg: 0}"), {half_root, half_root, 0, 0});
    expect_near(attitude_of("{roll_deg: 0, pitch_deg: 90, yaw_deg: 0}"), {half_root, 0, half_root, 0});
    expect_near(attitude_of("{roll_deg: 0, pitch_deg: 0, yaw_deg: 90}"), {half_root, 0, 0, half_root});
    // yaw o roll, by hand: k i = j.
    expect_near(attitude_of("{roll_deg: 90, pitch_deg: 0, yaw_deg: 90}"), {0.5, 0.5, 0.5, 0.5});
    // pitch o roll: j i = -k.
    expect_near(attitude_of("{roll_deg: 90, pitch_deg: 90, yaw_deg: 0}"), {0.5, 0.5, 0.5, -0.5});
}

TEST(Rotation, is_normalised_when_it_is_off_by_a_thousandth_at_most)
{
    expect_near(attitude_of("[0.7071, 0, 0, 0.7071]"), {half_root, 0, 0, half_root});
    expect_near(attitude_of("[0.9995, 0, 0, 0]"), {1, 0, 0, 0});
    expect_near(attitude_of("[[0, -0.9995, 0.0004], [1, 0, 0], [0, 0.0004, 1]]"), {half_root, 0, 0, half_root}, 1e-3);
    const auto q = attitude_of("[[0, -0.9995, 0.0004], [1, 0, 0], [0, 0.0004, 1]]");
    EXPECT_NEAR(std::hypot(std::hypot(q[0], q[1]), std::hypot(q[2], q[3])), 1, 1e-15);
}

TEST(Rotation, is_refused_with_its_norm_otherwise)
{
    EXPECT_THAT(attitude_refusal("[0.9985, 0, 0, 0]"),
                HasSubstr("unit.initial_attitude: expected a unit quaternion [w, x, y, z], its norm is 0.9985"));
    EXPECT_THAT(attitude_refusal("[1, 1, 0, 0]"), HasSubstr("its norm is 1.414"));
    EXPECT_THAT(attitude_refusal("[0, 0, 0, 0]"), HasSubstr("its norm is 0"));
    EXPECT_THAT(attitude_refusal("[[2, 0, 0], [0, 1, 0], [0, 0, 1]]"), HasSubstr("row 0 is no unit vector, its norm is 2"));
    EXPECT_THAT(attitude_refusal("[[1, 0, 0], [0.6, 0.8, 0], [0, 0, 1]]"),
                HasSubstr("rows 0 and 1 are not perpendicular, their product is 0.6"));
    EXPECT_THAT(attitude_refusal("[[1, 0, 0], [0, 1, 0], [0, 0, -1]]"), HasSubstr("a reflection, not a rotation"));
    EXPECT_THAT(attitude_refusal("[[.nan, 0, 0], [0, 1, 0], [0, 0, 1]]"), HasSubstr("its norm is nan"));
}

TEST(Rotation, is_refused_where_its_form_is_another)
{
    EXPECT_THAT(attitude_refusal("[1, 0, 0]"), HasSubstr("unit.initial_attitude: expected a quaternion"));
    EXPECT_THAT(attitude_refusal("north"), HasSubstr("unit.initial_attitude: expected a quaternion"));
    EXPECT_THAT(attitude_refusal("[[1, 0], [0, 1]]"), HasSubstr("expected three rows of three numbers"));
    EXPECT_THAT(attitude_refusal("{roll_deg: 1, yaw_deg: 2}"), HasSubstr("unit.initial_attitude.pitch_deg is missing"));
    EXPECT_THAT(attitude_refusal("{roll_deg: 1, pitch_deg: 2, yaw_deg: 2, heading_deg: 3}"), HasSubstr("unknown key 'heading_deg'"));
}

TEST(Rotation, of_an_imu_takes_all_forms_too)
{
    for (const char* rotation :
         {"[0.7071, 0, 0, 0.7071]", "[[0, -1, 0], [1, 0, 0], [0, 0, 1]]", "{roll_deg: 0, pitch_deg: 0, yaw_deg: 90}"}) {
        const auto system = loaded(with(ros2_file, "name: front", std::string("name: front, rotation: ") + rotation));
        ASSERT_TRUE(system) << system.error();
        const Eigen::Matrix3d expected{{0, -1, 0}, {1, 0, 0}, {0, 0, 1}};
        EXPECT_TRUE(system->sensor.source.ros2->imus[0].mounting.isApprox(expected, 1e-15)) << rotation;
        EXPECT_NEAR(system->sensor.cluster->axes(0, 1), 1, 1e-15) << "the IMU's x axis is the body's y axis";
    }
    EXPECT_THAT(refusal(with(ros2_file, "name: front", "name: front, rotation: [2, 0, 0, 0]")),
                HasSubstr("source.imus[0].rotation: expected a unit quaternion [w, x, y, z], its norm is 2"));
}

}  // namespace quorient::system
