#include "clusters.hpp"
#include "quorient/simulation/faults.hpp"

#include <gtest/gtest.h>
#include <cmath>
#include <numbers>
#include <vector>

namespace quorient::simulation {
namespace {

constexpr double interval_s = 0.01;
constexpr std::size_t faulty = 1;

double healthy_increment(std::uint64_t sequence, std::size_t axis)
{
    return 1e-3 * static_cast<double>(axis + 1) + 1e-5 * static_cast<double>(sequence);
}

SensorFrame healthy_frame(std::uint64_t sequence)
{
    SensorFrame frame;
    frame.sequence = sequence;
    frame.interval_s = interval_s;
    frame.axis_count = 6;
    frame.valid_mask = 0b111111;
    for (std::size_t axis = 0; axis < 6; ++axis) frame.increment[axis] = healthy_increment(sequence, axis);
    return frame;
}

struct Passage {
    std::vector<SensorFrame> frames;
    std::vector<AxisMask> touched;
};

/// 100 frames, 0 to 1 s, through an injector with this fault (none if empty).
Passage run_with(const std::string& fault)
{
    FaultInjector injector(two_triads(), 5);
    if (!fault.empty()) {
        const auto added = injector.add(*parse_fault(fault));
        EXPECT_TRUE(added) << added.error();
    }
    Passage run;
    for (std::uint64_t sequence = 0; sequence < 100; ++sequence) {
        SensorFrame frame = healthy_frame(sequence);
        run.touched.push_back(injector.apply(frame, static_cast<double>(sequence) * interval_s));
        run.frames.push_back(frame);
    }
    return run;
}

/// The faulty axis differs from health exactly in frames 20 … 39; the others never do.
void expect_only_in_its_window(const Passage& run)
{
    for (std::uint64_t sequence = 0; sequence < 100; ++sequence) {
        const bool inside = sequence >= 20 && sequence < 40;
        EXPECT_EQ(run.touched[sequence], inside ? axis_bit(faulty) : 0U) << "frame " << sequence;
        for (std::size_t axis = 0; axis < 6; ++axis) {
            if (inside && axis == faulty) continue;
            EXPECT_EQ(run.frames[sequence].increment[axis], healthy_increment(sequence, axis)) << "frame " << sequence << " axis " << axis;
            EXPECT_TRUE(has_axis(run.frames[sequence].valid_mask, axis));
        }
    }
}

double at(const Passage& run, std::uint64_t sequence)
{
    return run.frames[sequence].increment[faulty];
}

TEST(FaultInjector, leaves_everything_alone_without_a_fault)
{
    const Passage run = run_with("");
    for (std::uint64_t sequence = 0; sequence < 100; ++sequence) {
        EXPECT_EQ(run.touched[sequence], 0U);
        for (std::size_t axis = 0; axis < 6; ++axis) EXPECT_EQ(run.frames[sequence].increment[axis], healthy_increment(sequence, axis));
    }
}

TEST(FaultInjector, bias_adds_a_rate)
{
    const Passage run = run_with("axis=1,kind=bias,value=0.5,start=0.2,end=0.4");
    expect_only_in_its_window(run);
    EXPECT_NEAR(at(run, 30) - healthy_increment(30, faulty), 0.5 * interval_s, 1e-18);
}

TEST(FaultInjector, ramp_grows_from_its_start)
{
    const Passage run = run_with("axis=1,kind=ramp,value=2,start=0.2,end=0.4");
    expect_only_in_its_window(run);
    double swept = 0;
    for (std::uint64_t sequence = 20; sequence < 40; ++sequence) swept += at(run, sequence) - healthy_increment(sequence, faulty);
    EXPECT_NEAR(swept, 0.5 * 2 * 0.2 * 0.2, 1e-15);  // a t^2 / 2
}

TEST(FaultInjector, scale_multiplies)
{
    const Passage run = run_with("axis=1,kind=scale,value=0.8,start=0.2,end=0.4");
    expect_only_in_its_window(run);
    EXPECT_EQ(at(run, 30), 0.8 * healthy_increment(30, faulty));
}

TEST(FaultInjector, stuck_repeats_the_last_value_before_it)
{
    const Passage run = run_with("axis=1,kind=stuck,start=0.2,end=0.4");
    expect_only_in_its_window(run);
    for (std::uint64_t sequence = 20; sequence < 40; ++sequence) EXPECT_EQ(at(run, sequence), healthy_increment(19, faulty));
}

TEST(FaultInjector, stuck_from_the_first_frame_repeats_that_frame)
{
    const Passage run = run_with("axis=1,kind=stuck");
    EXPECT_EQ(run.touched[0], 0U);
    EXPECT_EQ(at(run, 50), healthy_increment(0, faulty));
}

TEST(FaultInjector, zero_is_zero)
{
    const Passage run = run_with("axis=1,kind=zero,start=0.2,end=0.4");
    expect_only_in_its_window(run);
    EXPECT_EQ(at(run, 30), 0.0);
}

TEST(FaultInjector, rail_is_the_range)
{
    const Passage run = run_with("axis=1,kind=rail,start=0.2,end=0.4");
    expect_only_in_its_window(run);
    EXPECT_DOUBLE_EQ(at(run, 30), 34.9 * interval_s);
}

TEST(FaultInjector, sign_turns_the_axis_round)
{
    const Passage run = run_with("axis=1,kind=sign,start=0.2,end=0.4");
    expect_only_in_its_window(run);
    EXPECT_EQ(at(run, 30), -healthy_increment(30, faulty));
}

TEST(FaultInjector, nan_stays_marked_valid_as_a_broken_driver_would)
{
    const Passage run = run_with("axis=1,kind=nan,start=0.2,end=0.4");
    expect_only_in_its_window(run);
    EXPECT_TRUE(std::isnan(at(run, 30)));
    EXPECT_TRUE(has_axis(run.frames[30].valid_mask, faulty));
}

TEST(FaultInjector, noise_has_the_stated_multiple_of_sigma)
{
    FaultInjector injector(two_triads(), 5);
    ASSERT_TRUE(injector.add(*parse_fault("axis=1,kind=noise,value=10")));
    double squares = 0;
    const int frames = 20000;
    for (std::uint64_t sequence = 0; sequence < frames; ++sequence) {
        SensorFrame frame = healthy_frame(sequence);
        injector.apply(frame, static_cast<double>(sequence) * interval_s);
        const double error = frame.increment[faulty] - healthy_increment(sequence, faulty);
        squares += error * error;
        EXPECT_EQ(frame.increment[2], healthy_increment(sequence, 2));
    }
    EXPECT_NEAR(std::sqrt(squares / frames), 10 * 1e-5, 0.03 * 1e-4);  // six standard errors
    expect_only_in_its_window(run_with("axis=1,kind=noise,value=10,start=0.2,end=0.4"));
}

TEST(FaultInjector, oscillation_is_the_integral_of_a_sine)
{
    const Passage run = run_with("axis=1,kind=oscillation,value=0.5,frequency=7,start=0.2,end=0.4");
    expect_only_in_its_window(run);
    const double w = 2 * std::numbers::pi * 7;
    double swept = 0;
    for (std::uint64_t sequence = 20; sequence < 30; ++sequence) swept += at(run, sequence) - healthy_increment(sequence, faulty);
    EXPECT_NEAR(swept, 0.5 / w * (1 - std::cos(w * 0.1)), 1e-14);
}

TEST(FaultInjector, dropout_loses_the_stated_fraction)
{
    FaultInjector injector(two_triads(), 5);
    ASSERT_TRUE(injector.add(*parse_fault("instrument=IMU1,kind=dropout,value=0.3")));
    int lost = 0;
    const int frames = 20000;
    for (std::uint64_t sequence = 0; sequence < frames; ++sequence) {
        SensorFrame frame = healthy_frame(sequence);
        const AxisMask touched = injector.apply(frame, static_cast<double>(sequence) * interval_s);
        EXPECT_TRUE(frame.valid_mask == 0b111111 || frame.valid_mask == 0b111000) << "the axes of one instrument fall silent together";
        EXPECT_EQ(touched, frame.valid_mask ^ 0b111111U);
        lost += frame.valid_mask != 0b111111 ? 1 : 0;
    }
    EXPECT_NEAR(lost / static_cast<double>(frames), 0.3, 0.02);  // six standard errors
    const Passage run = run_with("axis=1,kind=dropout,value=1,start=0.2,end=0.4");
    for (std::uint64_t sequence = 0; sequence < 100; ++sequence)
        EXPECT_EQ(has_axis(run.frames[sequence].valid_mask, faulty), sequence < 20 || sequence >= 40);
}

TEST(FaultInjector, delay_gives_what_was_measured_then)
{
    const Passage run = run_with("axis=1,kind=delay,value=0.05,start=0.2,end=0.4");
    expect_only_in_its_window(run);
    EXPECT_EQ(at(run, 30), healthy_increment(25, faulty));
    const Passage between = run_with("axis=1,kind=delay,value=0.025,start=0.2,end=0.4");
    EXPECT_NEAR(at(between, 30), (healthy_increment(28, faulty) + healthy_increment(27, faulty)) / 2, 1e-17);
}

TEST(FaultInjector, delay_has_no_sample_before_the_first)
{
    const Passage run = run_with("axis=1,kind=delay,value=0.05");
    for (std::uint64_t sequence = 0; sequence < 100; ++sequence)
        EXPECT_EQ(has_axis(run.frames[sequence].valid_mask, faulty), sequence >= 6) << "frame " << sequence;
}

TEST(FaultInjector, spike_comes_once_a_period)
{
    const Passage run = run_with("axis=1,kind=spike,value=3,period=0.1,start=0.2,end=0.4");
    for (std::uint64_t sequence = 0; sequence < 100; ++sequence) {
        const bool spike = sequence == 20 || sequence == 30;
        EXPECT_EQ(run.touched[sequence], spike ? axis_bit(faulty) : 0U) << "frame " << sequence;
        EXPECT_NEAR(at(run, sequence) - healthy_increment(sequence, faulty), spike ? 3 * interval_s : 0.0, 1e-17);
    }
}

TEST(FaultInjector, lets_faults_come_and_go_at_run_time)
{
    FaultInjector injector(two_triads(), 5);
    SensorFrame frame = healthy_frame(0);
    EXPECT_EQ(injector.apply(frame, 0.0), 0U);

    ASSERT_TRUE(injector.add(*parse_fault("instrument=IMU1,kind=zero")));
    frame = healthy_frame(1);
    EXPECT_EQ(injector.apply(frame, 0.01), 0b000111U);
    EXPECT_EQ(injector.active_axes(0.01), 0b000111U);

    injector.clear(axis_bit(0));
    frame = healthy_frame(2);
    EXPECT_EQ(injector.apply(frame, 0.02), 0b000110U);

    injector.clear();
    frame = healthy_frame(3);
    EXPECT_EQ(injector.apply(frame, 0.03), 0U);
    EXPECT_TRUE(injector.empty());
}

TEST(FaultInjector, refuses_more_faults_than_it_has_places)
{
    FaultInjector injector(two_triads(), 5);
    const auto fault = *parse_fault("axis=1,kind=zero");
    for (std::size_t i = 0; i < FaultInjector::capacity; ++i) EXPECT_TRUE(injector.add(fault));
    EXPECT_FALSE(injector.add(fault));
}

TEST(FaultInjector, takes_new_faults_in_the_places_of_those_that_have_ended)
{
    FaultInjector injector(two_triads(), 5);
    for (std::uint64_t sequence = 0; sequence < 3 * FaultInjector::capacity; ++sequence) {
        const double begin_s = static_cast<double>(sequence) * interval_s;
        FaultSpec fault = *parse_fault("axis=1,kind=zero");
        fault.start_s = begin_s;
        fault.end_s = begin_s + interval_s;
        ASSERT_TRUE(injector.add(fault)) << sequence;
        SensorFrame frame = healthy_frame(sequence);
        EXPECT_EQ(injector.apply(frame, begin_s), axis_bit(1));
    }
}

TEST(FrameAccumulator, sums_what_is_valid_and_counts_what_is_not)
{
    FrameAccumulator accumulator;
    SensorFrame frame = healthy_frame(0);
    accumulator.add(frame);
    frame = healthy_frame(1);
    frame.valid_mask &= ~axis_bit(0);
    frame.increment[1] = std::numeric_limits<double>::quiet_NaN();
    accumulator.add(frame);
    EXPECT_EQ(frame.missed[0], 1U);
    EXPECT_EQ(frame.missed[1], 1U);
    EXPECT_EQ(frame.missed[2], 0U);
    EXPECT_EQ(frame.accumulated[0], healthy_increment(0, 0));
    EXPECT_EQ(frame.accumulated[1], healthy_increment(0, 1));
    EXPECT_EQ(frame.accumulated[2], healthy_increment(0, 2) + healthy_increment(1, 2));

    accumulator.skip(3);
    frame = healthy_frame(5);
    accumulator.add(frame);
    EXPECT_EQ(frame.missed[2], 3U);
}

}  // namespace
}  // namespace quorient::simulation
