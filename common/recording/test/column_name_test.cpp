#include "csv/column_name.hpp"

#include <gtest/gtest.h>
#include <ostream>

namespace quorient::recording::csv {
namespace {

struct Case {
    const char* text;
    Quantity quantity;
    int axis;  // -1 = none
    const char* owner;
    const char* unit;
};

void PrintTo(const Case& column, std::ostream* stream)
{
    *stream << '\'' << column.text << '\'';
}

class ColumnNames : public testing::TestWithParam<Case> {};

TEST_P(ColumnNames, are_understood)
{
    const Case& expected = GetParam();
    const ColumnName name = read_column_name(expected.text);
    EXPECT_EQ(name.quantity, expected.quantity) << expected.text;
    EXPECT_EQ(name.axis ? static_cast<int>(*name.axis) : -1, expected.axis) << expected.text;
    EXPECT_EQ(name.unit, expected.unit) << expected.text;
    if (expected.owner == nullptr) return;
    EXPECT_EQ(name.owner, expected.owner) << expected.text;
}

constexpr auto rate = Quantity::rate;
constexpr auto time_q = Quantity::time;
constexpr auto other = Quantity::other;

INSTANTIATE_TEST_SUITE_P(
    Gyros, ColumnNames,
    testing::Values(Case{"gx", rate, 0, "", ""}, Case{"Gz", rate, 2, "", ""}, Case{"g0y", rate, 1, "0", ""},
                    Case{"gyro_x_rad_s", rate, 0, "", "rad/s"}, Case{"gx [deg/s]", rate, 0, "", "deg/s"},
                    Case{"Gyroscope y (rad/s)", rate, 1, "", "rad/s"}, Case{"\"GyrX\"", rate, 0, "", ""},
                    Case{"IMU2_GyrZ", rate, 2, "imu 2", ""}, Case{"gyro_z_1", rate, 2, "1", ""}, Case{"gx1", rate, 0, "1", ""},
                    Case{"/imu0/angular_velocity/x", rate, 0, "imu 0", ""}, Case{"field.angular_velocity.y", rate, 1, "field", ""},
                    Case{"gyroADC[1] (deg/s)", rate, 1, "", "deg/s"}, Case{"gyro_rad[2]", rate, 2, "", "rad"}, Case{"wx", rate, 0, "", ""},
                    Case{"omega_z", rate, 2, "", ""}, Case{"w_x (\xC2\xB0/s)", rate, 0, "", "deg/s"}, Case{"xgyro", rate, 0, "", ""},
                    Case{"gz_dps", rate, 2, "", "deg/s"}, Case{"q", rate, 1, "", ""}, Case{"yaw_rate", rate, 2, "", ""},
                    Case{"x", rate, 0, "", ""}, Case{"gy mdps", rate, 1, "", "mdeg/s"}, Case{"imu1.gyro.x", rate, 0, "imu 1", ""}));

INSTANTIATE_TEST_SUITE_P(
    OtherColumns, ColumnNames,
    testing::Values(Case{"increment_4", Quantity::increment, 4, "", ""}, Case{"delta_angle[0]", Quantity::increment, 0, "", ""},
                    Case{"delta_angle_dt", Quantity::interval, -1, nullptr, ""}, Case{"dt", Quantity::interval, -1, "", ""},
                    Case{"AccX", Quantity::acceleration, 0, "", ""}, Case{"accelerometer_m_s2[1]", Quantity::acceleration, 1, "", "m/s^2"},
                    Case{"a0x", Quantity::acceleration, 0, "0", ""}, Case{"temperature", Quantity::temperature, -1, "", ""},
                    Case{"id", Quantity::identity, -1, "", ""}, Case{"imu", Quantity::identity, -1, "", ""},
                    Case{"I", Quantity::identity, -1, "", ""}, Case{"PacketCounter", Quantity::counter, -1, nullptr, ""},
                    Case{"time", time_q, -1, "", ""}, Case{"time_s", time_q, -1, "", "s"}, Case{"t", time_q, -1, "", ""},
                    Case{"ts", time_q, -1, "", ""}, Case{"TimeUS", time_q, -1, "", "us"}, Case{"t [ns]", time_q, -1, "", "ns"},
                    Case{"timestamp_sample", time_q, -1, "", ""}, Case{"time (us)", time_q, -1, "", "us"},
                    Case{"%time", time_q, -1, "", ""}, Case{"header.stamp.secs", time_q, -1, nullptr, "s"},
                    Case{"header.stamp.nsecs", Quantity::time_fraction, -1, nullptr, "ns"}, Case{"Euler_X", other, -1, nullptr, ""},
                    Case{"Mag_X", other, -1, nullptr, ""}, Case{"gyro_device_id", other, -1, nullptr, ""},
                    Case{"q[0]", other, -1, nullptr, ""}, Case{"gyroUnfilt[0]", other, -1, nullptr, ""},
                    Case{"x [m]", other, -1, nullptr, ""}, Case{"field.angular_velocity_covariance0", other, -1, nullptr, ""},
                    Case{"imu_status", other, -1, nullptr, ""}, Case{"", other, -1, "", ""}));

TEST(ColumnNames, of_three_columns_tell_the_instrument)
{
    EXPECT_EQ(common_name({"g0x", "g0y", "g0z"}), "g0");
    EXPECT_EQ(common_name({"IMU2_GyrX", "IMU2_GyrY", "IMU2_GyrZ"}), "IMU2");
    EXPECT_EQ(common_name({"/imu0/angular_velocity/x", "/imu0/angular_velocity/y", "/imu0/angular_velocity/z"}), "/imu0");
    EXPECT_EQ(common_name({"gyro_x_1", "gyro_y_1", "gyro_z_1"}), "gyro_1");
    EXPECT_EQ(common_name({"gx", "gy", "gz"}), "");
    EXPECT_EQ(common_name({"p", "q", "r"}), "");
}

}  // namespace
}  // namespace quorient::recording::csv
