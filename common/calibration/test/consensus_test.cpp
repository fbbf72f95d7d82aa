#include "quorient/calibration/consensus.hpp"

#include "quorient/calibration/calibration.hpp"
#include "quorient/calibration/silence.hpp"
#include "quorient/geometry/sensor_cluster.hpp"
#include "synthetic.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <Eigen/Dense>

namespace quorient::calibration {
namespace {

constexpr double degree = 3.14159265358979323846 / 180;

/// Three sound triads whose axes, gains and biases differ as those of consumer gyros do; a test spoils one of them.
class SetAside : public testing::Test {
protected:
    std::mt19937_64 random_{20261129};
    Truth truth_ = three_triads(random_);

    Calibration calibrated(double begin_s = 0, double end_s = 120)
    {
        samples_ = record(truth_, end_s, random_);
        samples_.erase(samples_.begin(), samples_.begin() + static_cast<std::ptrdiff_t>(begin_s / interval_s));
        auto calibration = calibrate(samples_, nominal_description());
        if (!calibration) throw std::runtime_error(calibration.error());
        return *calibration;
    }

    std::vector<Sample> samples_;
};

TEST_F(SetAside, nobody_where_all_instruments_are_sound)
{
    const Calibration calibration = calibrated();
    EXPECT_TRUE(calibration.outside.empty());
    EXPECT_TRUE(calibration.axes_note.empty()) << calibration.axes_note;
}

TEST_F(SetAside, an_axis_of_half_the_gain_and_its_instruments_others_stay)
{
    truth_.gain(2) = 0.47;
    for (const double begin_s : {0.0, 21.0}) {  // with rest, and from the motion alone
        const Calibration calibration = calibrated(begin_s, begin_s > 0 ? 59 : 120);
        ASSERT_EQ(calibration.outside.size(), 1U);
        EXPECT_EQ(calibration.outside[0].axis, 2U);
        EXPECT_EQ(calibration.outside[0].kind, OutsideClass::Kind::gain);
        EXPECT_NEAR(calibration.outside[0].gain, 0.47, 0.01);
        EXPECT_DOUBLE_EQ(calibration.cluster.gain[2], 1.0) << "not absorbed";
        EXPECT_DOUBLE_EQ(calibration.cluster.description.bias[2], 0.0);
        for (const Eigen::Index axis : {0, 1, 3, 4, 5, 6, 7, 8}) {
            const double scale = truth_.gain(axis) / calibration.cluster.gain[static_cast<std::size_t>(axis)];
            EXPECT_NEAR(scale, truth_.gain(8) / calibration.cluster.gain[8], 0.03) << "axis " << axis;
        }
    }
}

TEST_F(SetAside, a_bias_outside_the_class_a_reversed_axis_and_nothing_else)
{
    truth_.bias_rad_s(7) += 12 * degree;
    truth_.gain(3) = -truth_.gain(3);
    const Calibration calibration = calibrated();
    // Two of three instruments have a fault, and no two agree.
    EXPECT_TRUE(calibration.outside.empty());
    EXPECT_THAT(calibration.axes_note, testing::HasSubstr("no majority"));
    EXPECT_DOUBLE_EQ(calibration.cluster.gain[3], 1.0);

    truth_.gain(3) = -truth_.gain(3);
    const Calibration biased = calibrated();
    ASSERT_EQ(biased.outside.size(), 1U);
    EXPECT_EQ(biased.outside[0].axis, 7U);
    EXPECT_EQ(biased.outside[0].kind, OutsideClass::Kind::bias);
    EXPECT_NEAR(biased.outside[0].bias_rad_s, truth_.bias_rad_s(7), 1 * degree);

    truth_.bias_rad_s(7) -= 12 * degree;
    truth_.gain(3) = -truth_.gain(3);
    const Calibration reversed = calibrated();
    ASSERT_EQ(reversed.outside.size(), 1U);
    EXPECT_EQ(reversed.outside[0].axis, 3U);
    EXPECT_EQ(reversed.outside[0].kind, OutsideClass::Kind::sign);
    EXPECT_NEAR(reversed.outside[0].gain, -1, 0.03);
}

TEST_F(SetAside, a_soft_axis_of_the_first_instrument_which_is_mounted_in_a_frame_of_its_own)
{
    const Eigen::Matrix3d turn = Eigen::AngleAxisd(2.3, Eigen::Vector3d(1, -2, 0.5).normalized()).toRotationMatrix();
    truth_.axes.topRows(3) = (truth_.axes.topRows(3) * turn).eval();
    truth_.gain(1) = 0.6;
    const Calibration calibration = calibrated();
    ASSERT_EQ(calibration.outside.size(), 1U);
    EXPECT_EQ(calibration.outside[0].axis, 1U);
    EXPECT_NEAR(calibration.outside[0].gain, 0.6, 0.01);
    EXPECT_LT(calibration.axes_residual_rad_s, 2 * truth_.sigma_rad_s);
    // The first instrument's frame is the body's: its axes keep their directions, the second one's are turned into it.
    const Eigen::Vector3d first = Eigen::Vector3d::Map(calibration.cluster.description.axis[0].data());
    EXPECT_GT(first(0), std::cos(0.05));
    const Eigen::Vector3d second = Eigen::Vector3d::Map(calibration.cluster.description.axis[3].data());
    EXPECT_GT(second.dot(turn * truth_.axes.row(3).transpose()), std::cos(0.05));
}

TEST_F(SetAside, is_isolated_in_the_replay_of_its_own_log_and_no_other)
{
    Calibration sound = calibrated();
    const auto silent = make_silent(samples_, sound);
    ASSERT_TRUE(silent);
    for (const Replayed& replayed : silent->replayed) EXPECT_EQ(replayed.isolated, 0U) << replayed.method;

    truth_.gain(5) = 0.47;
    Calibration soft = calibrated();
    const auto isolated = make_silent(samples_, soft);
    ASSERT_TRUE(isolated);
    EXPECT_EQ(isolated->replayed[0].method, "field");
    EXPECT_EQ(isolated->replayed[0].isolated, AxisMask{0b000111000}) << "by " << isolated->replayed[0].method;
}

TEST(Spread, of_a_single_rest_is_not_known)
{
    std::mt19937_64 random(7);
    const auto once = record(three_triads(random), 19, random);
    const auto calibration = calibrate(once, nominal_description());
    ASSERT_TRUE(calibration) << calibration.error();
    ASSERT_EQ(calibration->rest.size(), 1U);
    EXPECT_EQ(to_yaml(calibration->cluster).find("bias_spread_rad_s"), std::string::npos);
}

}  // namespace
}  // namespace quorient::calibration
