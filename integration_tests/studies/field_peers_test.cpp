// The rules of PX4 and ArduPilot beside Quorient, on a simulated flight whose faults are known.

#include "field_peers.hpp"
#include "field_trial.hpp"

#include "quorient/messages/meaning.hpp"
#include "quorient/messages/units.hpp"

#include <gtest/gtest.h>
#include <cmath>

namespace quorient::studies {
namespace {

constexpr double interval_s = 0.01;
constexpr double rest_s = 6;

/// Three triads with white noise of 0.1 deg/s: a rest, then turns.
FieldLog flight()
{
    FieldLog log{.name = "simulated", .cluster = {}, .frames = {}};
    log.cluster.axes = geometry::Axes::Zero(9, 3);
    for (std::size_t axis = 0; axis < 9; ++axis) {
        log.cluster.axes(static_cast<Eigen::Index>(axis), static_cast<Eigen::Index>(axis % 3)) = 1;
        log.cluster.instrument.push_back(axis / 3);
        if (axis % 3 == 0) log.cluster.instrument_name.push_back("g" + std::to_string(axis / 3));
    }
    log.cluster.sigma.setZero(9);
    log.cluster.quantum.setZero(9);
    log.cluster.range.setZero(9);
    log.cluster.interval_s = interval_s;
    std::mt19937_64 random(1);
    std::normal_distribution<double> noise(0, 0.1);
    for (std::uint64_t k = 0; k < 4000; ++k) {
        const double t = interval_s * static_cast<double>(k);
        const double size = t < rest_s ? 0 : 1;
        SensorFrame frame;
        frame.epoch = 1;
        frame.sequence = k;
        frame.sample_time_ns = static_cast<std::int64_t>(k) * 10'000'000;
        frame.interval_s = interval_s;
        frame.kind = octet(SensorKind::gyro);
        frame.axis_count = 9;
        frame.valid_mask = log.cluster.all();
        for (std::size_t axis = 0; axis < 9; ++axis) {
            const double rate = size * 80 * std::sin((1.1 + 0.3 * static_cast<double>(axis % 3)) * t) + noise(random);
            frame.increment[axis] = rate * degree * interval_s;
        }
        log.frames.push_back(frame);
    }
    return log;
}

Injection bias(double deg_s, double at_s)
{
    return {.fault = {.name = "bias", .spoil = Spoil::bias, .size = deg_s * degree, .kind = Diagnosis::bias},
            .instrument = 1,
            .axis = 4,
            .onset = static_cast<std::size_t>(at_s / interval_s)};
}

FaultRun play(const FieldLog& log, const Injection& injection)
{
    return play_fault(log, injection, 1, fdi::FaultMonitor::make(fdi::DetectorSettings{.method = "field"}, {}, log.cluster).value());
}

TEST(BesidePeers, px4_flies_by_a_bias_until_its_integral_passes_15_degrees)
{
    const FieldLog log = flight();
    const FaultRun run = play(log, bias(22.9, 10));
    // Against the mean of three: 2/3 of 22.9 less 7 deg/s fills 15 degrees in 1.82 s, and its low-pass takes 0.2 s.
    EXPECT_FALSE(run.px4.wrong);
    EXPECT_NEAR(run.px4.named_s, 1.82 + 0.2 * 22.9 * 2 / 3 / (22.9 * 2 / 3 - 7), 0.1);
    EXPECT_NEAR(run.px4.attitude.largest_rad / degree, 22.9 * run.px4.named_s, 0.15 * 22.9 * run.px4.named_s);
    EXPECT_EQ(run.px4.attitude.at_end_rad, 0);
    EXPECT_LT(run.attitude.largest_rad, 1.5 * degree);
    EXPECT_LT(run.attitude.at_end_rad, 0.5 * degree);
}

TEST(BesidePeers, both_fly_by_a_bias_below_their_limits_to_the_end)
{
    const FieldLog log = flight();
    const FaultRun run = play(log, bias(4, 10));
    EXPECT_FALSE(std::isfinite(run.px4.named_s));
    EXPECT_GT(run.px4.attitude.at_end_rad, 10 * degree);
    EXPECT_EQ(run.ardupilot.attitude.at_end_rad, run.px4.attitude.at_end_rad);
    EXPECT_FALSE(run.ardupilot.refuses);
    EXPECT_LT(run.attitude.at_end_rad, 0.5 * degree);
}

TEST(BesidePeers, ardupilot_refuses_what_differs_by_more_than_5_deg_s_before_the_first_motion_only)
{
    const FieldLog log = flight();
    EXPECT_TRUE(refuses_to_arm(log, bias(6, 3), 1));
    EXPECT_FALSE(refuses_to_arm(log, bias(4, 3), 1));
    EXPECT_FALSE(refuses_to_arm(log, bias(60, 10), 1)) << "in flight it compares nothing";
}

TEST(BesidePeers, an_attitude_forgets_what_is_left_out_afterwards)
{
    const FieldLog log = flight();
    Attitude late(log.cluster, log.cluster.all());
    Attitude never(log.cluster, log.cluster.all() & ~log.cluster.axes_of(1));
    Spoiler spoiler(log, bias(60, 10), 1);
    for (std::size_t k = 1000; k < 1200; ++k) {
        SensorFrame frame = log.frames[k];
        spoiler.apply(k, frame);
        late.add(frame);
        never.add(frame);
    }
    EXPECT_GT(rotation::angle_between(late.after(199), never.after(199)), 10 * degree);
    Exclusions excluded;
    excluded.exclude(log.cluster.axes_of(1), 1000);
    late.leave_out(excluded);
    for (std::size_t k = 0; k < 200; ++k) EXPECT_LT(rotation::angle_between(late.after(k), never.after(k)), 1e-12);
}

}  // namespace
}  // namespace quorient::studies
