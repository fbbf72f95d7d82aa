// Four axes: an axis whose rate turns round repeats its value for many frames. That alone must not make it stuck while another axis is faulty.

#include "coning_model.hpp"
#include "measured_frame.hpp"
#include "quorient/fdi/fault_monitor.hpp"

#include <gtest/gtest.h>

#include <functional>
#include <numbers>
#include <random>

namespace quorient::fdi {
namespace {

constexpr double interval_s = 0.01;
constexpr std::uint64_t onset = 400;
constexpr double period_s = 2 * std::numbers::pi / 0.05;

/// What a faulty axis gives out for what it should.
using Fault = std::function<double(std::uint64_t sequence, double increment)>;

struct Run {
    double begin_s = 0;
    std::size_t faulty = 0;
    std::uint64_t seed = 0;
};

/// Axes isolated on the paper's motion, one of them faulty from `onset` on.
AxisMask isolated(const Run& run, const Fault& fault)
{
    const auto cluster = cone_4(interval_s);
    auto monitor = FaultMonitor::make({.method = "vector"}, {}, cluster).value();
    std::mt19937_64 random(run.seed);
    CarryingQuantiser quantise(quantum, random);
    const ConingModel motion;
    AxisMask isolated = 0;
    for (std::uint64_t sequence = 0; sequence < onset + 300; ++sequence) {
        const Eigen::Vector4d exact = cluster.axes * motion.increment(run.begin_s + interval_s * static_cast<double>(sequence), interval_s);
        const SensorFrame frame = measured_frame(sequence, interval_s, exact, [&](std::size_t axis, double increment) {
            const double sound = quantise(axis, increment);
            return axis == run.faulty ? fault(sequence, sound) : sound;
        });
        isolated |= monitor.assess(frame).isolated_mask;
    }
    return isolated;
}

struct Count {
    int runs = 0;
    int named = 0;
    int blamed = 0;  ///< a sound axis was isolated
};

/// Each axis in turn fails at each of 400 phases of the motion.
Count over_all_phases(const Fault& fault)
{
    constexpr int phases = 400;
    Count count;
    for (int phase = 0; phase < phases; ++phase)
        for (std::size_t axis = 0; axis < 4; ++axis, ++count.runs) {
            const AxisMask found =
                isolated({.begin_s = phase * period_s / phases, .faulty = axis, .seed = static_cast<std::uint64_t>(count.runs)}, fault);
            if (has_axis(found, axis)) ++count.named;
            if ((found & ~axis_bit(axis)) != 0) ++count.blamed;
        }
    return count;
}

/// With any two axes that moved as witnesses, isolated ones among them, 29 of these 1600 blamed a sound axis.
TEST(TurningPoint, a_bias_that_begins_and_ends_blames_no_axis_that_turns_round_meanwhile)
{
    const Count count = over_all_phases(
        [](std::uint64_t sequence, double increment) { return increment + (sequence >= onset && sequence < onset + 100 ? 0.05 * interval_s : 0); });
    EXPECT_EQ(count.blamed, 0);
    EXPECT_EQ(count.named, count.runs);
}

/// Likewise 127 of 1600.
TEST(TurningPoint, a_ramp_blames_no_axis_that_turns_round_meanwhile)
{
    const Count count = over_all_phases([](std::uint64_t sequence, double increment) {
        return increment + (sequence >= onset ? 0.01 * interval_s * interval_s * static_cast<double>(sequence - onset) : 0);
    });
    EXPECT_EQ(count.blamed, 0);
    EXPECT_EQ(count.named, count.runs);
}

/// The others fail at their own turning point, where the fault is small for as long as the run lasts.
TEST(TurningPoint, an_axis_that_is_stuck_is_named_by_the_method)
{
    double held = 0;
    const Count count = over_all_phases([&](std::uint64_t sequence, double increment) {
        if (sequence < onset) held = increment;
        return held;
    });
    EXPECT_EQ(count.blamed, 0);
    EXPECT_GT(count.named, count.runs * 96 / 100);
}

}  // namespace
}  // namespace quorient::fdi
