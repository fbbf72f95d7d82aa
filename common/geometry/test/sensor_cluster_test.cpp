#include "quorient/geometry/sensor_cluster.hpp"

#include "quorient/geometry/layouts.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <algorithm>
#include <cmath>
#include <limits>

namespace quorient::geometry {
namespace {

using testing::HasSubstr;

Axes body_axes_and(const Eigen::RowVector3d& fourth)
{
    Axes axes(4, 3);
    axes << Eigen::Matrix3d::Identity(), fourth;
    return axes;
}

TEST(SensorCluster, uses_rows_exactly_as_given_within_the_tolerance)
{
    const auto cluster = make_cluster(body_axes_and({0, 0.6, 0.80007}));
    ASSERT_TRUE(cluster) << cluster.error();
    EXPECT_EQ(cluster->axes(3, 2), 0.80007);
    EXPECT_EQ(cluster->size(), 4U);
    EXPECT_EQ(cluster->all(), 0b1111U);
}

TEST(SensorCluster, refuses_a_norm_off_by_more_than_the_tolerance_and_names_the_axis)
{
    EXPECT_THAT(make_cluster(body_axes_and({0, 0.6, 0.8002})).error(), HasSubstr("axis 3: norm 1.00016"));
}

TEST(SensorCluster, refuses_axes_in_one_plane)
{
    Axes axes(4, 3);
    axes << 1, 0, 0, 0, 1, 0, 0.6, 0.8, 0, -0.6, 0.8, 0;
    EXPECT_THAT(make_cluster(axes).error(), HasSubstr("in one plane"));
    axes.row(3) = Eigen::RowVector3d(0, 0.8, 0.6);
    EXPECT_TRUE(make_cluster(axes));
}

TEST(SensorCluster, refuses_axes_on_one_line)
{
    Axes axes(4, 3);
    axes << 1, 0, 0, -1, 0, 0, 1, 0, 0, 1, 0, 0;
    EXPECT_THAT(make_cluster(axes).error(), HasSubstr("on one line"));
}

TEST(SensorCluster, accepts_duplicated_axes_that_span_space)
{
    EXPECT_TRUE(make_cluster(body_axes_and({0, 0, 1})));
}

TEST(SensorCluster, refuses_fewer_than_three_axes)
{
    EXPECT_THAT(make_cluster(Axes(Eigen::Matrix3d::Identity().topRows(2))).error(), HasSubstr("at least 3"));
    EXPECT_THAT(make_cluster(Axes(0, 3)).error(), HasSubstr("at least 3"));
}

TEST(SensorCluster, refuses_what_is_not_finite)
{
    for (const double bad : {std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity()})
        EXPECT_THAT(make_cluster(body_axes_and({0, 0, bad})).error(), HasSubstr("axis 3: (0, 0, "));
}

TEST(SensorCluster, refuses_instrument_numbers_with_gaps_or_of_another_count)
{
    EXPECT_THAT(make_cluster(body_axes_and({0, 0, 1}), {0, 0, 2, 2}).error(), HasSubstr("instrument 1 has no axis"));
    EXPECT_THAT(make_cluster(body_axes_and({0, 0, 1}), {0, 0, 1}).error(), HasSubstr("3 instrument numbers"));
}

TEST(SensorCluster, knows_the_axes_of_an_instrument)
{
    const auto cluster = make_cluster(body_axes_and({0, 0, 1}), {0, 1, 0, 1}).value();
    EXPECT_EQ(cluster.axes_of(0), 0b0101U);
    EXPECT_EQ(cluster.axes_of(1), 0b1010U);
    EXPECT_EQ(cluster.axes_of(2), 0U);
}

ClusterDescription description_of_three_triads()
{
    ClusterDescription description;
    const auto cluster = layout("triads-3").value();
    description.axis_count = 9;
    for (std::size_t axis = 0; axis < 9; ++axis) {
        for (std::size_t k = 0; k < 3; ++k)
            description.axis[axis][k] = cluster.axes(static_cast<Eigen::Index>(axis), static_cast<Eigen::Index>(k));
        description.instrument[axis] = static_cast<std::uint8_t>(axis / 3);
        description.sigma[axis] = 1e-6 * static_cast<double>(axis);
    }
    description.interval_s = 0.005;
    std::ranges::copy(std::string_view("port"), description.instrument_name[1].begin());
    return description;
}

TEST(SensorCluster, is_made_from_its_description)
{
    const auto cluster = make_cluster(description_of_three_triads());
    ASSERT_TRUE(cluster) << cluster.error();
    EXPECT_EQ(cluster->axes, layout("triads-3")->axes);
    EXPECT_EQ(cluster->instrument, layout("triads-3")->instrument);
    EXPECT_THAT(cluster->instrument_name, testing::ElementsAre("IMU1", "port", "IMU3"));
    EXPECT_EQ(cluster->sigma(8), 8e-6);
    EXPECT_EQ(cluster->interval_s, 0.005);
}

TEST(SensorCluster, refuses_bad_noise_figures_and_counts_of_a_description)
{
    const auto complaint = [](auto spoil) {
        auto description = description_of_three_triads();
        spoil(description);
        const auto cluster = make_cluster(description);
        return cluster ? std::string("accepted") : cluster.error();
    };
    EXPECT_EQ(complaint([](auto&) {}), "accepted");
    EXPECT_THAT(complaint([](auto& d) { d.sigma[4] = -1; }), HasSubstr("noise of axis 4 is -1"));
    EXPECT_THAT(complaint([](auto& d) { d.quantum[2] = std::nan(""); }), HasSubstr("quantum of axis 2"));
    EXPECT_THAT(complaint([](auto& d) { d.sigma[3] = 2.25e-105; }),
                HasSubstr("noise of axis 3 is 2.25e-105; 0 (unknown) or 1e-15 to 1000"));
    EXPECT_THAT(complaint([](auto& d) { d.quantum[3] = 1e200; }), HasSubstr("quantum of axis 3 is 1e+200"));
    EXPECT_THAT(complaint([](auto& d) { d.sigma[3] = 8e-13; }), HasSubstr("more than 1e+06 times the noise"));
    EXPECT_THAT(complaint([](auto& d) { d.quantum[3] = 9; }), HasSubstr("more than 1e+06 times the noise"));
    EXPECT_EQ(complaint([](auto& d) { d.sigma[3] = 9e-12, d.quantum[3] = 1e-15, d.sigma[8] = 0; }), "accepted");
    EXPECT_THAT(complaint([](auto& d) { d.range[0] = std::numeric_limits<double>::infinity(); }), HasSubstr("range of axis 0"));
    EXPECT_THAT(complaint([](auto& d) { d.interval_s = std::nan(""); }), HasSubstr("interval"));
    EXPECT_THAT(complaint([](auto& d) { d.axis_count = 25; }), HasSubstr("at most 24"));
    EXPECT_THAT(complaint([](auto& d) { d.axis_count = 0; }), HasSubstr("at least 3"));
    EXPECT_THAT(complaint([](auto& d) { d.axis[5] = {0, 0, 0.9}; }), HasSubstr("axis 5: norm"));
}

}  // namespace
}  // namespace quorient::geometry
