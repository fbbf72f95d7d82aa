#include "quorient/recording/rest_statistics.hpp"

#include "log_files.hpp"

#include <gmock/gmock.h>
#include <random>
#include <sstream>

namespace quorient::recording {
namespace {

using testing::HasSubstr;

class RestStatisticsOf : public LogFiles {};

/// Three axes at 100 Hz: two seconds of rest with known bias and noise (axis 2 without any), then a turn if asked for.
std::string log_text(bool turning)
{
    std::mt19937_64 random(3);
    std::normal_distribution<double> noise(0.0, 1.0);
    std::ostringstream text;
    text.precision(17);
    text << "time,increment_0,increment_1,increment_2\n";
    for (int i = 1; i <= 400; ++i)
        text << i * 0.01 << ',' << 0.01 * (0.02 + (turning && i > 200 ? 0.01 * i : 0.0)) + 1e-4 * noise(random) << ','
             << 0.01 * -0.01 + 2e-4 * noise(random) << ",0.001\n";
    return text.str();
}

TEST_F(RestStatisticsOf, a_resting_log_are_bias_and_noise)
{
    const auto reader = open_log(write("rest.csv", log_text(false)));
    ASSERT_TRUE(reader) << reader.error();
    const auto rest = rest_statistics(**reader, 4.0);
    ASSERT_TRUE(rest) << rest.error();
    EXPECT_EQ(rest->samples, 400U);
    EXPECT_NEAR(rest->duration_s, 4.0, 1e-9);
    EXPECT_NEAR(rest->bias_rad_s[0], 0.02, 4 * 0.01 / 20);  // four standard errors
    EXPECT_NEAR(rest->bias_rad_s[1], -0.01, 4 * 0.02 / 20);
    EXPECT_NEAR(rest->sigma_rad[0], 1e-4, 1.5e-5);
    EXPECT_NEAR(rest->sigma_rad[1], 2e-4, 3e-5);
    EXPECT_EQ(rest->constant_mask, 0b100U);
}

TEST_F(RestStatisticsOf, a_moving_log_are_refused)
{
    const auto moving = open_log(write("move.csv", log_text(true)));
    EXPECT_THAT(rest_statistics(**moving, 4.0).error(), AllOf(HasSubstr("axis 0"), HasSubstr("not at rest")));
    const auto resting_part = open_log(write("move.csv", log_text(true)));
    EXPECT_TRUE(rest_statistics(**resting_part, 2.0));
}

TEST_F(RestStatisticsOf, a_log_that_is_too_short_are_refused)
{
    const auto reader = open_log(write("rest.csv", log_text(false)));
    EXPECT_THAT(rest_statistics(**reader, 0.05).error(), HasSubstr("at least 10"));
}

TEST(RestStatisticsOfRecording, agree_with_what_the_data_page_says)
{
    const auto file = data_dir() / "mimu4444_carlsson" / "exp_1" / "data.bin";
    if (!std::filesystem::exists(file)) GTEST_SKIP() << "no recordings under " << data_dir();
    const auto reader = open_log(file);
    const auto rest = rest_statistics(**reader, 10.0);
    ASSERT_TRUE(rest) << rest.error();
    constexpr double degree = 3.14159265358979 / 180;
    for (std::size_t axis = 0; axis < 24; ++axis) {
        EXPECT_GT(rest->sigma_rad[axis] / 0.016, 0.08 * degree) << "axis " << axis;
        EXPECT_LT(rest->sigma_rad[axis] / 0.016, 0.55 * degree) << "axis " << axis;
        EXPECT_LT(std::abs(rest->bias_rad_s[axis]), 5 * degree) << "axis " << axis;
    }
}

}  // namespace
}  // namespace quorient::recording
