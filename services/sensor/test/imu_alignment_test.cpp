#include "imu_alignment.hpp"

#include <gtest/gtest.h>
#include <cmath>
#include <functional>
#include <limits>

namespace quorient::sensor {

namespace {

using Fault = ImuAlignment::Fault;

constexpr std::int64_t ms = 1'000'000;
constexpr double interval_s = 0.01;
constexpr std::int64_t interval_ns = 10 * ms;
constexpr std::int64_t period_ns = 4 * ms;                       // every IMU's: 250 Hz
constexpr std::int64_t ros_time_ns = 1'700'000'000'000'000'000;  // the IMUs' clock where the steady clock is 0

/// The true body rate, and its integral.
Eigen::Vector3d rate_at(double s)
{
    return {0.5 * std::sin(2 * s), 0.2, 0.3 * std::cos(3 * s)};
}
Eigen::Vector3d angle_at(double s)
{
    return {-0.25 * std::cos(2 * s), 0.2 * s, 0.1 * std::sin(3 * s)};
}

/// Three IMUs on a robot whose time is the steady clock plus ros_time_ns; each test spoils one of them, or their clock.
class Robot : public testing::Test {
protected:
    struct Sent {
        bool sent = true;
        std::int64_t stamp_error_ns = 0;
        std::int64_t delay_ns = ms;
        std::uint32_t publishers = 1;
        double factor = 1;
        int times = 1;
    };
    using Spoil = std::function<Sent(std::size_t imu, std::int64_t now_ns)>;

    Robot()
    {
        settings.imus.resize(3);
        settings.skew_s = 0.02;
    }

    /// Runs so long and calls back after every frame.
    void run(double duration_s, const Spoil& spoil, const std::function<void(std::int64_t now_ns)>& frame)
    {
        ImuAlignment made{settings, SensorKind::gyro, interval_s};
        alignment = &made;
        bool started = false;
        std::int64_t due_ns = 0;
        for (std::int64_t now = 0; now < std::llround(duration_s * 1e9); now += ms) {
            for (std::size_t imu = 0; imu < 3; ++imu) send(imu, now, spoil(imu, now));
            if (!started && made.ready(now)) {
                made.start(now);
                started = true;
                due_ns = now + interval_ns;
            }
            if (!started || now < due_ns) continue;
            due_ns += interval_ns;
            made.advance(now);
            frame(now);
        }
        alignment = nullptr;
        EXPECT_TRUE(started);
    }

    /// What was measured a delay ago arrives now. The IMUs measure out of step with each other.
    void send(std::size_t imu, std::int64_t now, const Sent& how)
    {
        const std::int64_t measured = now - how.delay_ns;
        if (!how.sent || (measured + static_cast<std::int64_t>(imu) * ms) % period_ns != 0) return;
        bus::ros2::Imu message;
        message.stamp_ns = ros_time_ns + measured + how.stamp_error_ns;
        const Eigen::Vector3d rate = rate_at(static_cast<double>(measured) * 1e-9) * how.factor;
        message.rate_rad_s = {rate.x(), rate.y(), rate.z()};
        for (int i = 0; i < how.times; ++i) alignment->add(imu, message, now, how.publishers);
    }

    /// The second IMU is spoiled from 1 s to 1.5 s.
    void expect_only_the_second_imu_fails(const Sent& spoiled, Fault fault)
    {
        int failed = 0, frames_within = 0;
        double back_s = 0;
        const auto spoil = [&](std::size_t imu, std::int64_t now) {
            return imu == 1 && now >= 1000 * ms && now < 1500 * ms ? spoiled : Sent{};
        };
        run(3, spoil, [&](std::int64_t now) {
            const auto& instruments = alignment->instruments();
            EXPECT_TRUE(instruments[0].valid && instruments[2].valid) << now;
            const bool within = now >= 1040 * ms && now < 1500 * ms;
            frames_within += within;
            if (!instruments[1].valid) {
                failed += within;
                EXPECT_TRUE(!within || instruments[1].fault == fault) << now << ": " << to_string(instruments[1].fault);
                EXPECT_GE(now, 1000 * ms);
                back_s = static_cast<double>(now) * 1e-9;
            }
        });
        EXPECT_EQ(failed, frames_within);
        EXPECT_LT(back_s, 1.6) << "it measures again soon after";
    }

    system::Ros2SourceSettings settings;
    ImuAlignment* alignment = nullptr;
};

TEST_F(Robot, gives_every_imu_the_same_interval_and_the_integral_of_its_rate)
{
    // Trapezoidal rule: |w''| h^3 / 12 per pair of samples, 2.7 * (4 ms)^3 / 12 each, and 3.5 pairs to an interval.
    const double bound_rad = 2.7 * 6.4e-8 / 12 * 3.5;
    int frames = 0;
    std::int64_t last_end = 0;
    run(
        3, [](std::size_t, std::int64_t) { return Sent{}; },
        [&](std::int64_t now) {
            const double begin_s = static_cast<double>(alignment->begin_ns() - ros_time_ns) * 1e-9;
            const double end_s = static_cast<double>(alignment->end_ns() - ros_time_ns) * 1e-9;
            for (const auto& instrument : alignment->instruments()) {
                ASSERT_TRUE(instrument.valid) << now;
                EXPECT_LT((instrument.increment - (angle_at(end_s) - angle_at(begin_s))).norm(), bound_rad);
            }
            EXPECT_TRUE(frames++ == 0 || alignment->begin_ns() == last_end) << now;
            last_end = alignment->end_ns();
            EXPECT_NEAR(end_s - begin_s, interval_s, interval_s * 1.1e-3);
        });
    EXPECT_GT(frames, 290);
}

TEST_F(Robot, leaves_out_an_imu_that_falls_silent)
{
    expect_only_the_second_imu_fails({.sent = false}, Fault::silent);
}

TEST_F(Robot, leaves_out_an_imu_whose_messages_come_too_late)
{
    expect_only_the_second_imu_fails({.delay_ns = 30 * ms}, Fault::skewed);
}

TEST_F(Robot, waits_for_an_imu_that_is_late_within_the_skew)
{
    run(
        3, [](std::size_t imu, std::int64_t) { return Sent{.delay_ns = imu == 1 ? 14 * ms : ms}; },
        [&](std::int64_t now) { EXPECT_TRUE(alignment->instruments()[1].valid) << now; });
}

TEST_F(Robot, leaves_out_an_imu_whose_stamps_jump_ahead)
{
    expect_only_the_second_imu_fails({.stamp_error_ns = 5'000 * ms}, Fault::skewed);
}

TEST_F(Robot, leaves_out_an_imu_whose_stamps_jump_back)
{
    expect_only_the_second_imu_fails({.stamp_error_ns = -100 * ms}, Fault::skewed);
}

TEST_F(Robot, leaves_out_an_imu_that_two_nodes_publish)
{
    expect_only_the_second_imu_fails({.publishers = 2}, Fault::duplicated);
}

TEST_F(Robot, leaves_out_an_imu_whose_messages_come_twice)
{
    expect_only_the_second_imu_fails({.times = 2}, Fault::duplicated);
}

TEST_F(Robot, leaves_out_an_imu_that_sends_no_numbers)
{
    expect_only_the_second_imu_fails({.factor = std::numeric_limits<double>::quiet_NaN()}, Fault::not_finite);
}

TEST_F(Robot, follows_a_clock_that_drifts)
{
    const auto drifting = [](std::size_t, std::int64_t now) { return Sent{.stamp_error_ns = now / 5000}; };  // 200 ppm
    double worst_s = 0;
    run(60, drifting, [&](std::int64_t now) {
        for (const auto& instrument : alignment->instruments()) ASSERT_TRUE(instrument.valid) << now;
        const double error_s = static_cast<double>(now - 20 * ms) * 1e-9 - static_cast<double>(alignment->end_ns() - ros_time_ns) * 1e-9;
        worst_s = std::max(worst_s, std::abs(error_s));
    });
    EXPECT_LT(worst_s, 0.02) << "12 ms of drift, and the frames went with it";
}

TEST_F(Robot, goes_with_the_clock_when_all_imus_are_set_together)
{
    std::uint64_t steps = 0;
    int invalid = 0;
    bool valid_at_end = false;
    run(
        5, [](std::size_t, std::int64_t now) { return Sent{.stamp_error_ns = now >= 2000 * ms ? 3600'000 * ms : 0}; },
        [&](std::int64_t) {
            steps = alignment->clock_steps();
            valid_at_end = true;
            for (const auto& instrument : alignment->instruments()) {
                invalid += !instrument.valid;
                valid_at_end = valid_at_end && instrument.valid;
            }
        });
    EXPECT_EQ(steps, 1U);
    EXPECT_TRUE(valid_at_end);
    EXPECT_LT(invalid, 3 * 80) << "0.8 s of frames without a measurement";
}

TEST_F(Robot, starts_without_an_imu_that_is_not_there)
{
    int frames = 0;
    run(
        3, [](std::size_t imu, std::int64_t) { return Sent{.sent = imu != 2}; },
        [&](std::int64_t) {
            ++frames;
            EXPECT_TRUE(alignment->instruments()[0].valid && alignment->instruments()[1].valid);
            EXPECT_EQ(alignment->instruments()[2].fault, Fault::silent);
        });
    EXPECT_GT(frames, 150);
}

TEST(Accelerations, are_moved_to_the_bodys_origin)
{
    // A body that turns about z with a growing rate, an accelerometer 0.3 m out along x, mounted a quarter turn about z.
    system::Ros2SourceSettings settings;
    settings.imus.resize(1);
    settings.imus[0].mounting << 0, -1, 0, 1, 0, 0, 0, 0, 1;
    settings.imus[0].position_m = {0.3, 0, 0};
    ImuAlignment alignment{settings, SensorKind::accelerometer, interval_s};
    const double alpha = 2;
    const Eigen::Vector3d at_origin(0.5, -0.25, 9.81);
    std::int64_t now = 0;
    for (; now < 100 * ms; now += period_ns) {
        const double rate = alpha * static_cast<double>(now) * 1e-9;
        const Eigen::Vector3d body = at_origin + Eigen::Vector3d(-rate * rate * 0.3, alpha * 0.3, 0);  // centripetal, tangential
        const Eigen::Vector3d measured = settings.imus[0].mounting.transpose() * body;
        bus::ros2::Imu message;
        message.stamp_ns = ros_time_ns + now;
        message.rate_rad_s = {0, 0, rate};
        message.acceleration_m_s2 = {measured.x(), measured.y(), measured.z()};
        alignment.add(0, message, now, 1);
    }
    ASSERT_TRUE(alignment.ready(now));
    alignment.start(now);
    alignment.advance(now);
    ASSERT_TRUE(alignment.instruments()[0].valid);
    const Eigen::Vector3d increment = settings.imus[0].mounting * alignment.instruments()[0].increment;
    EXPECT_LT((increment - at_origin * interval_s).norm(), 1e-12);
}

}  // namespace

}  // namespace quorient::sensor
