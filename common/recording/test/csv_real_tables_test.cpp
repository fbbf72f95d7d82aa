#include "instrument_log_test.hpp"

#include <gmock/gmock.h>
#include <algorithm>
#include <cmath>

namespace quorient::recording {
namespace {

using testing::Contains;
using testing::HasSubstr;

constexpr double degree = 3.14159265358979323846 / 180;

struct FieldCase {
    const char* file;
    std::size_t rows;
    std::vector<std::string> names;
    const char* unit;
};

TEST(CsvLog, reads_the_real_tables_as_their_owners_mean_them)
{
    if (!std::filesystem::exists(field_dir())) GTEST_SKIP() << "no logs under " << field_dir();
    const std::vector<FieldCase> cases{{"cats_drone_healthy.csv", 3 * 3722, {"g0", "g1", "g2"}, "rad/s"},
                                       {"cats_drone_soft_axis_1.csv", 3 * 4249, {"g0", "g1", "g2"}, "rad/s"},
                                       {"cats_rocket_pyro_long.csv", 4416, {"IMU0", "IMU1"}, "deg/s"},
                                       {"cats_rocket_healthy_long.csv", 28094, {"IMU1", "IMU2", "IMU0"}, "deg/s"},
                                       {"rover_5_imus/imu1.csv", 7412, {"imu1"}, "rad/s"},
                                       {"rover_5_imus/imu5.csv", 7242, {"imu5"}, "rad/s"}};
    for (const FieldCase& given : cases) {
        SCOPED_TRACE(given.file);
        const Samples log = samples_of(open_instruments(field_dir() / given.file));
        EXPECT_EQ(log.names(), given.names);
        EXPECT_EQ(log.samples.size(), given.rows);
        EXPECT_TRUE(log.problems.empty());
        EXPECT_THAT(log.remarks, Contains(HasSubstr(std::string("gyros read as ") + given.unit)));
    }
    EXPECT_THAT(open_instruments(field_dir() / "cats_drop_counts_long.csv").error(), HasSubstr("--lsb-per-deg-s"));
    const Samples drop = samples_of(open_instruments(field_dir() / "cats_drop_counts_long.csv", {{}, 16.4, {}}));
    double fastest = 0;
    for (const InstrumentSample& sample : drop.samples) fastest = std::max(fastest, std::abs(sample.rate_rad_s[2]));
    EXPECT_LT(fastest / degree, 850);
}

TEST(CsvLog, reads_xsens_dots_with_their_own_clock)
{
    const auto folder = data_dir() / "ansfl_quadrotor_4xDOT" / "StraightLine" / "RAW";
    if (!std::filesystem::exists(folder)) GTEST_SKIP() << "no recordings under " << data_dir();
    for (const auto& entry : std::filesystem::directory_iterator(folder)) {
        SCOPED_TRACE(entry.path().filename().string());
        const Samples log = samples_of(open_instruments(entry.path(), {RateUnit::deg_s, {}, {}}));
        ASSERT_EQ(log.instruments.size(), 1U);
        EXPECT_EQ(log.instruments[0].stamps, StampKind::sampling);
        EXPECT_GT(log.samples.size(), 17'000U);
    }
}

}  // namespace
}  // namespace quorient::recording
