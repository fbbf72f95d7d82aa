#include "quorient/calibration/calibration.hpp"

#include "quorient/calibration/axes_fit.hpp"
#include "synthetic.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <Eigen/Dense>

namespace quorient::calibration {
namespace {

using testing::HasSubstr;

/// What cannot be seen (a turn and scale common to all axes) taken out: H P with P mapping back on the nominal axes as best.
Eigen::MatrixX3d seen_from_nominal(const geometry::Axes& axes, const geometry::AxisVector& gain)
{
    const Eigen::MatrixX3d scaled = gain.asDiagonal() * axes;
    const Eigen::Matrix3d back = (scaled.transpose() * scaled).inverse() * scaled.transpose() * nominal_axes();
    return scaled * back;
}

class Calibrating : public testing::Test {
protected:
    std::mt19937_64 random_{20240613};
    Truth truth_ = three_triads(random_);
};

TEST_F(Calibrating, finds_biases_noise_directions_and_gains)
{
    const auto samples = record(truth_, 240, random_);
    const auto calibration = calibrate(samples, nominal_description());
    ASSERT_TRUE(calibration) << calibration.error();
    ASSERT_TRUE(calibration->motion) << calibration->axes_note;
    geometry::Axes axes(9, 3);
    geometry::AxisVector gain(9);
    for (Eigen::Index axis = 0; axis < 9; ++axis) {
        const auto i = static_cast<std::size_t>(axis);
        EXPECT_NEAR(calibration->cluster.description.bias[i], truth_.bias_rad_s(axis), 1e-4);
        EXPECT_NEAR(calibration->cluster.description.sigma[i], truth_.sigma_rad_s * interval_s / calibration->cluster.gain[i], 5e-7);
        axes.row(axis) = Eigen::RowVector3d::Map(calibration->cluster.description.axis[i].data());
        gain(axis) = calibration->cluster.gain[i];
        EXPECT_NEAR(axes.row(axis).norm(), 1.0, 1e-14);
    }
    EXPECT_LT((seen_from_nominal(axes, gain) - seen_from_nominal(truth_.axes, truth_.gain)).lpNorm<Eigen::Infinity>(), 2e-4);
    EXPECT_NEAR(gain.mean(), 1.0, 1e-14);
    EXPECT_NEAR(calibration->axes_residual_rad_s, truth_.sigma_rad_s, 0.1 * truth_.sigma_rad_s);
    EXPECT_LT(calibration->motion->noise.along_s, 2e-5) << "there is no motion noise to find";
    EXPECT_LT(calibration->motion->noise.across_s, 2e-5);
}

TEST_F(Calibrating, finds_the_motion_noise)
{
    truth_.along_s = 3e-4;
    truth_.across_s = 1e-4;
    const auto samples = record(truth_, 240, random_);
    const auto calibration = calibrate(samples, nominal_description());
    ASSERT_TRUE(calibration) << calibration.error();
    ASSERT_TRUE(calibration->motion) << calibration->axes_note;
    EXPECT_NEAR(calibration->motion->noise.along_s, truth_.along_s, 0.1 * truth_.along_s);
    EXPECT_NEAR(calibration->motion->noise.across_s, truth_.across_s, 0.1 * truth_.across_s);
    const auto& windows = calibration->motion->windows;
    EXPECT_NEAR(windows[2].residual_rad_s, windows[0].residual_rad_s / 4, 0.2 * windows[0].residual_rad_s / 4)
        << "white: 16 frames average to a quarter";
}

TEST_F(Calibrating, keeps_nominal_axes_without_motion_and_says_why)
{
    const auto samples = record(truth_, 19, random_);
    const auto calibration = calibrate(samples, nominal_description());
    ASSERT_TRUE(calibration) << calibration.error();
    EXPECT_FALSE(calibration->motion);
    EXPECT_THAT(calibration->axes_note, HasSubstr("motion"));
    EXPECT_EQ(calibration->cluster.description.axis, nominal_description().axis);
    EXPECT_EQ(calibration->cluster.gain[4], 1.0);
}

TEST_F(Calibrating, reports_where_sensors_saturate_and_leaves_those_samples_out)
{
    const auto free = calibrate(record(truth_, 240, random_), nominal_description());
    ASSERT_TRUE(free) << free.error();
    EXPECT_EQ(free->saturation_limit_rad_s[2], 0.0);
    EXPECT_EQ(free->saturated[2], 0U);

    truth_.limit_rad_s = 5.5;
    const auto samples = record(truth_, 240, random_);
    const auto clipped = calibrate(samples, nominal_description());
    ASSERT_TRUE(clipped) << clipped.error();
    EXPECT_DOUBLE_EQ(clipped->saturation_limit_rad_s[2], 5.5);
    std::uint64_t at_limit = 0;
    for (const Sample& sample : samples) at_limit += std::abs(sample.rate(2)) == 5.5 ? 1 : 0;
    EXPECT_EQ(clipped->saturated[2], at_limit);
    EXPECT_LT(clipped->axes_residual_rad_s, 1.2 * truth_.sigma_rad_s);
}

TEST_F(Calibrating, refuses_logs_that_say_nothing)
{
    auto samples = record(truth_, 60, random_);
    for (Sample& sample : samples) sample.rate(4) = 0.25;
    EXPECT_THAT(calibrate(samples, nominal_description()).error(), HasSubstr("axis 4 is constant"));

    EXPECT_FALSE(calibrate({}, nominal_description()));
    EXPECT_FALSE(calibrate(samples, ClusterDescription{}));
}

TEST_F(Calibrating, without_rest_tells_only_the_biases_that_differ)
{
    const auto samples = record(truth_, 60, random_);
    const auto calibration = calibrate(Samples(samples).subspan(2100, 3800), nominal_description());
    ASSERT_TRUE(calibration) << calibration.error();
    EXPECT_TRUE(calibration->rest.empty());
    const geometry::Axes h = truth_.gain.asDiagonal() * truth_.axes;
    const Eigen::VectorXd common = h * (h.transpose() * h).inverse() * (h.transpose() * truth_.bias_rad_s);
    for (Eigen::Index axis = 0; axis < 9; ++axis)
        EXPECT_NEAR(calibration->cluster.description.bias[static_cast<std::size_t>(axis)], truth_.bias_rad_s(axis) - common(axis), 3e-4)
            << "axis " << axis;
    EXPECT_NEAR(calibration->at_rest.deviation_rad_s(3), truth_.sigma_rad_s, 0.1 * truth_.sigma_rad_s);
}

TEST_F(Calibrating, finds_how_instruments_are_mounted)
{
    const Eigen::Matrix3d turn = Eigen::AngleAxisd(2.3, Eigen::Vector3d(1, -2, 0.5).normalized()).toRotationMatrix();
    truth_.axes.middleRows(3, 3) = (truth_.axes.middleRows(3, 3) * turn).eval();
    const auto calibration = calibrate(record(truth_, 120, random_), nominal_description());
    ASSERT_TRUE(calibration) << calibration.error();
    ASSERT_TRUE(calibration->motion) << calibration->axes_note;
    for (std::size_t axis = 3; axis < 6; ++axis) {
        const Eigen::RowVector3d fitted = Eigen::RowVector3d::Map(calibration->cluster.description.axis[axis].data());
        const double cosine = fitted.dot(truth_.axes.row(static_cast<Eigen::Index>(axis)));
        EXPECT_GT(cosine, std::cos(0.05)) << "axis " << axis;  // a turn of the whole cluster is not seen: misalignments of 0.01 rad stay
    }
}

TEST_F(Calibrating, refuses_a_triad_that_never_rests)
{
    auto samples = record(truth_, 60, random_);
    for (Sample& sample : samples) sample.rate = sample.rate.head(3).eval();
    ClusterDescription triad = nominal_description();
    triad.axis_count = 3;
    EXPECT_THAT(calibrate(Samples(samples).subspan(2100, 3800), triad).error(),
                AllOf(HasSubstr("no resting segment"), HasSubstr("redundancy")));
    EXPECT_TRUE(calibrate(samples, triad));
}

RateMoment moment_of(const std::vector<geometry::AxisVector>& rates)
{
    RateMoment moment(rates.front().size());
    for (const geometry::AxisVector& rate : rates) moment.add(rate);
    return moment;
}

TEST(FitAxes, needs_redundancy_and_motion_about_three_axes)
{
    std::vector<geometry::AxisVector> flat;
    for (int i = 0; i < 100; ++i) flat.emplace_back(nominal_axes() * Eigen::Vector3d(std::sin(i), std::cos(i), 0));
    EXPECT_THAT(fit_axes(moment_of(flat), nominal_axes()).error(), HasSubstr("one body axis"));
    EXPECT_FALSE(fit_axes(RateMoment(9), nominal_axes()));
    const geometry::Axes triad = nominal_axes().topRows(3);
    EXPECT_THAT(fit_axes(moment_of({geometry::AxisVector::Ones(3)}), triad).error(), HasSubstr("redundancy"));

    std::vector<geometry::AxisVector> full;
    for (int i = 0; i < 100; ++i) full.emplace_back(nominal_axes() * Eigen::Vector3d(std::sin(i), std::cos(i), std::sin(3 * i)));
    EXPECT_TRUE(fit_axes(moment_of(full), nominal_axes()));
}

}  // namespace
}  // namespace quorient::calibration
