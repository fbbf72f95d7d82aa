#include "verdict/axis_health.hpp"

#include "measured_frame.hpp"
#include "quorient/fdi/fault_monitor.hpp"
#include "quorient/geometry/layouts.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <random>
#include <vector>

namespace quorient::fdi {
namespace {

constexpr double interval_s = 0.01;
constexpr double sigma_rad = 2e-5;
constexpr double quantum_rad = 2e-5;
constexpr double range_rad_s = 10;

/// Six noisy, quantised axes; a test spoils axis 2.
class AxisHealthTest : public ::testing::Test {
protected:
    AxisHealthTest()
    {
        cluster_.sigma.setConstant(sigma_rad);
        cluster_.quantum.setConstant(quantum_rad);
        cluster_.range.setConstant(range_rad_s);
        cluster_.interval_s = interval_s;
        health_.emplace(cluster_);
    }

    static Eigen::Vector3d rest(unsigned) { return Eigen::Vector3d::Zero(); }
    static Eigen::Vector3d wild(unsigned frame)
    {
        const double t = frame * interval_s;
        return {3 * std::sin(20 * t), 4 * std::cos(17 * t), 3 * std::sin(23 * t + 1)};
    }

    /// @param spoil  what axis 2 says instead of the value given; NaN for nothing.
    template <class Motion, class Spoil>
    AxisMask feed(unsigned frames, Motion motion, Spoil spoil)
    {
        AxisMask broken = 0;
        for (unsigned i = 0; i < frames; ++i, ++frame_) {
            const geometry::AxisVector exact = cluster_.axes * motion(frame_) * interval_s;
            for (std::size_t axis = 0; axis < 6; ++axis)
                z_[axis] = std::round((exact(static_cast<Eigen::Index>(axis)) + noise_(random_)) / quantum_rad) * quantum_rad;
            z_[2] = spoil(z_[2]);
            broken |= health_->assess({.identity = {1, frame_}, .interval_s = interval_s, .increment = z_, .valid = 0b111111});
        }
        return broken;
    }

    static double sound(double value) { return value; }

    geometry::SensorCluster cluster_ = geometry::layout("cone-6").value();
    std::optional<AxisHealth> health_;
    std::vector<double> z_ = std::vector<double>(6);
    unsigned frame_ = 0;
    std::mt19937_64 random_{12};
    std::normal_distribution<double> noise_{0, sigma_rad};
};

TEST_F(AxisHealthTest, finds_nothing_wrong_with_sound_axes_at_rest_and_in_motion)
{
    EXPECT_EQ(feed(200'000, rest, sound), 0U) << "at rest a quantised axis repeats itself many times";
    EXPECT_EQ(feed(50'000, wild, sound), 0U);
}

TEST_F(AxisHealthTest, finds_a_stuck_axis_at_the_fourth_repeat_while_the_others_move)
{
    feed(500, wild, sound);
    const double stuck = z_[2];
    EXPECT_EQ(feed(3, wild, [&](double) { return stuck; }), 0U) << "repeats are normal";
    EXPECT_EQ(feed(1, wild, [&](double) { return stuck; }), 0b100U);
    EXPECT_EQ(health_->fault(2), AxisFault::stuck);
}

TEST_F(AxisHealthTest, finds_a_stuck_axis_where_neither_noise_nor_quantum_is_stated)
{
    cluster_.sigma.setZero();
    cluster_.quantum.setZero();
    health_.emplace(cluster_);
    EXPECT_EQ(feed(20'000, rest, sound) | feed(5000, wild, sound), 0U);
    const double stuck = z_[2];
    EXPECT_EQ(feed(20, wild, [&](double) { return stuck; }), 0b100U);
}

TEST_F(AxisHealthTest, forgives_each_value_that_comes_three_times_in_motion)
{
    double held = 0;
    unsigned frame = 0;
    const auto every_third = [&](double value) { return frame++ % 3 == 0 ? held = value : held; };
    EXPECT_EQ(feed(6000, wild, every_third), 0U);
}

TEST_F(AxisHealthTest, leaves_an_axis_in_peace_that_repeats_itself_at_rest)
{
    feed(2000, rest, sound);
    const double stuck = z_[2];
    EXPECT_EQ(feed(100'000, rest, [&](double) { return stuck; }), 0U) << "a coarse axis at rest repeats itself for ever";
    EXPECT_EQ(feed(10, wild, [&](double) { return stuck; }), 0b100U) << "and is found as soon as the others move";
}

TEST_F(AxisHealthTest, leaves_a_resting_axis_in_peace_while_one_other_axis_is_wrong)
{
    cluster_.sigma.setConstant(quantum_rad / 10);
    health_.emplace(cluster_);
    feed(500, wild, sound);
    AxisMask broken = 0;
    for (unsigned i = 0; i < 2000; ++i) {
        z_.assign(6, 0.0);
        z_[5] = 1e-2 * std::sin(0.3 * i);
        broken |= health_->assess({.identity = {1, 1000 + i}, .interval_s = interval_s, .increment = z_, .valid = 0b111111});
    }
    EXPECT_EQ(broken, 0U);
}

TEST_F(AxisHealthTest, takes_no_isolated_axis_for_a_witness_against_one_that_rests)
{
    cluster_.sigma.setConstant(quantum_rad / 10);
    const auto broken_with = [&](AxisMask isolated) {
        health_.emplace(cluster_);
        feed(500, wild, sound);
        AxisMask broken = 0;
        for (unsigned i = 0; i < 2000; ++i) {
            z_.assign(6, 0.0);
            for (const std::size_t wrong : {4U, 5U}) z_[wrong] = 1e-2 * std::sin(0.3 * i);
            broken |= health_->assess({.identity = {1, 1000 + i}, .interval_s = interval_s, .increment = z_, .valid = 0b111111}, isolated);
        }
        return broken;
    };
    EXPECT_NE(broken_with(0), 0U) << "two that are wrong outvote the others";
    EXPECT_EQ(broken_with(0b100000), 0U);
}

/// Two instruments of three axes: what the other one measures is all there is to compare with.
class TwoInstruments : public ::testing::Test {
protected:
    TwoInstruments()
    {
        cluster_.interval_s = interval_s;
    }

    /// @param spoil  what the six axes give out for what they should [rad].
    AxisMask feed(unsigned frames, double sigma, const std::function<Eigen::Vector3d(unsigned)>& increment,
                  const std::function<void(std::vector<double>&)>& spoil)
    {
        AxisMask broken = 0;
        for (unsigned i = 0; i < frames; ++i, ++frame_) {
            const Eigen::Vector3d exact = increment(frame_);
            for (std::size_t axis = 0; axis < 6; ++axis)
                z_[axis] = std::round((exact(static_cast<Eigen::Index>(axis % 3)) + sigma * normal_(random_)) / quantum_rad) * quantum_rad;
            spoil(z_);
            broken |= health_->assess({.identity = {1, frame_}, .interval_s = interval_s, .increment = z_, .valid = 0b111111});
        }
        return broken;
    }

    static Eigen::Vector3d turning(unsigned frame)
    {
        return 0.02 * Eigen::Vector3d(std::sin(0.2 * frame), std::cos(0.17 * frame), std::sin(0.23 * frame + 1));
    }
    static void nothing(std::vector<double>&) {}

    geometry::SensorCluster cluster_ = geometry::layout("triads-2").value();
    std::optional<AxisHealth> health_;
    std::vector<double> z_ = std::vector<double>(6);
    unsigned frame_ = 0;
    std::mt19937_64 random_{12};
    std::normal_distribution<double> normal_;
};

TEST_F(TwoInstruments, a_noisy_axis_that_repeats_itself_is_stuck)
{
    health_.emplace(cluster_);
    EXPECT_EQ(feed(2000, 4 * quantum_rad, turning, nothing), 0U);
    const double stuck = z_[2];
    EXPECT_EQ(feed(20, 4 * quantum_rad, turning, [&](std::vector<double>& z) { z[2] = stuck; }), 0b100U);
}

TEST_F(TwoInstruments, a_coarse_axis_that_rests_is_not_stuck_because_the_other_instrument_is_wrong)
{
    health_.emplace(cluster_);
    feed(2000, quantum_rad / 10, turning, nothing);
    const auto about_y = [](unsigned frame) { return Eigen::Vector3d(0, 0.02 * std::sin(0.2 * frame), 0); };
    EXPECT_EQ(feed(2000, quantum_rad / 10, about_y, [&](std::vector<double>& z) { z[3] = z[5] = 0.01 * std::sin(0.3 * frame_); }), 0U);
}

TEST_F(AxisHealthTest, tells_an_all_zero_axis)
{
    feed(500, wild, sound);
    EXPECT_EQ(feed(6, wild, [](double) { return 0.0; }), 0b100U);
    EXPECT_EQ(health_->fault(2), AxisFault::zero);
}

TEST_F(AxisHealthTest, reports_an_axis_without_data_and_never_calls_it_broken)
{
    const auto silent = [](double) { return std::nan(""); };
    EXPECT_EQ(feed(7, wild, silent), 0U);
    EXPECT_EQ(health_->absent(), 0U) << "a few lost samples";
    feed(40, wild, sound);
    EXPECT_EQ(feed(1000, wild, silent), 0U);
    EXPECT_EQ(health_->absent(), 0b100U);
    feed(7, wild, sound);
    EXPECT_EQ(health_->absent(), 0b100U);
    feed(1, wild, sound);
    EXPECT_EQ(health_->absent(), 0U) << "back";
}

TEST_F(AxisHealthTest, tells_a_value_beyond_the_range)
{
    EXPECT_EQ(feed(1, wild, [](double) { return 1.1 * range_rad_s * interval_s; }), 0b100U);
    EXPECT_EQ(health_->fault(2), AxisFault::out_of_range);
}

TEST_F(AxisHealthTest, tells_an_axis_at_its_rail_from_a_body_that_turns_that_fast)
{
    feed(10, wild, sound);
    EXPECT_EQ(feed(1, wild, [](double) { return range_rad_s * interval_s; }), 0b100U);
    EXPECT_EQ(health_->fault(2), AxisFault::rail);

    const Eigen::Vector3d along = cluster_.axes.row(2);
    EXPECT_EQ(feed(
                  50, [&](unsigned) { return Eigen::Vector3d(0.99 * range_rad_s * along); }, sound),
              0U);
}

/// Three triads; which axes are broken when the body turns about x at this rate and one axis along x says something else.
AxisMask broken_of_three_triads(double rate_rad_s, std::size_t axis, double says_rad_s)
{
    auto cluster = geometry::layout("triads-3").value();
    cluster.sigma.setConstant(sigma_rad);
    cluster.range.setConstant(range_rad_s);
    cluster.interval_s = interval_s;
    AxisHealth health(cluster);
    const geometry::AxisVector exact = cluster.axes * Eigen::Vector3d(rate_rad_s * interval_s, 0, 0);
    std::vector<double> z(exact.data(), exact.data() + exact.size());
    z[axis] = says_rad_s * interval_s;
    return health.assess({.identity = {1, 0}, .interval_s = interval_s, .increment = z, .valid = cluster.all()});
}

TEST_F(AxisHealthTest, does_not_take_sound_axes_at_their_range_for_railed_because_a_faulty_one_denies_it)
{
    for (const double says : {0.0, -0.99 * range_rad_s}) EXPECT_EQ(broken_of_three_triads(0.99 * range_rad_s, 3, says), 0U) << says;
    EXPECT_EQ(broken_of_three_triads(0.1 * range_rad_s, 3, 0.99 * range_rad_s), 0b1000U) << "a railed axis is found as ever";
}

TEST_F(AxisHealthTest, forgives_the_repeats_of_an_axis_beyond_whose_range_the_body_turns)
{
    constexpr double limit_rad_s = 2.5;
    cluster_.range(2) = limit_rad_s;
    health_.emplace(cluster_);
    const auto clipped = [](double value) { return std::clamp(value, -limit_rad_s * interval_s, limit_rad_s * interval_s); };
    EXPECT_EQ(feed(50'000, wild, clipped), 0U);
    EXPECT_EQ(feed(50, wild, [](double) { return 0.9 * limit_rad_s * interval_s; }), 0b100U) << "frozen elsewhere it is found";
}

TEST_F(AxisHealthTest, what_is_broken_is_isolated_by_the_monitor_without_any_parity)
{
    auto monitor = FaultMonitor::make({.method = "glt"}, {}, cluster_).value();
    std::uint64_t isolated_at = never;
    AxisMask isolated = 0;
    for (unsigned frame = 0; frame < 600; ++frame) {
        const geometry::AxisVector exact = cluster_.axes * wild(frame) * interval_s;
        auto message = measured_frame(frame, interval_s, exact, [this](std::size_t, double increment) { return increment + noise_(random_); });
        if (frame >= 300) message.increment[2] = range_rad_s * interval_s;
        isolated = monitor.assess(message).isolated_mask;
        if (isolated != 0) isolated_at = std::min<std::uint64_t>(isolated_at, frame);
    }
    EXPECT_EQ(isolated, 0b100U);
    EXPECT_GE(isolated_at, 300U);
    EXPECT_LE(isolated_at, 310U);
}

TEST_F(AxisHealthTest, what_sends_nothing_is_never_isolated_and_returns_with_its_data)
{
    auto monitor = FaultMonitor::make({.method = "glt"}, {}, cluster_).value();
    for (unsigned frame = 0; frame < 900; ++frame) {
        SensorFrame message;
        message.epoch = 1;
        message.sequence = frame;
        message.interval_s = interval_s;
        message.axis_count = 6;
        const bool silent = frame >= 300 && frame < 600;
        message.valid_mask = silent ? 0b110011 : 0b111111;
        const geometry::AxisVector z = cluster_.axes * wild(frame) * interval_s;
        for (std::size_t axis = 0; axis < 6; ++axis) message.increment[axis] = z(static_cast<Eigen::Index>(axis)) + noise_(random_);
        ASSERT_EQ(monitor.assess(message).isolated_mask, 0U) << frame;
        const bool reported = frame >= 320 && frame < 600;
        if (reported) {
            ASSERT_EQ(monitor.diagnosis().absent_mask, 0b001100U) << frame;
        }
        if (frame >= 620) {
            ASSERT_EQ(monitor.diagnosis().absent_mask, 0U) << frame;
        }
    }
}

}  // namespace
}  // namespace quorient::fdi
