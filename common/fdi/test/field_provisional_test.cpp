// From a contradiction to the verdict: what is left out, for how long, and what is latched.

#include "field_scene.hpp"
#include "quorient/fdi/fault_monitor.hpp"
#include "field/field_detector.hpp"
#include "quorient/messages/meaning.hpp"

#include <gtest/gtest.h>
#include <algorithm>

namespace quorient::fdi {
namespace {

constexpr std::uint64_t onset = 1200;
constexpr double frame_s = 0.01;

/// A scene with the whole detector behind it.
class FieldProvisional : public ::testing::Test {
protected:
    void begin(std::size_t instruments, std::uint64_t seed, const DetectorSettings& settings = {.method = "field"})
    {
        scene_.emplace(instruments, seed);
        monitor_.emplace(FaultMonitor::make(settings, {}, scene_->cluster).value());
    }

    const FaultVerdict& next()
    {
        const Measurement measurement = scene_->next();
        SensorFrame frame;
        frame.epoch = measurement.identity.epoch;
        frame.sequence = measurement.identity.sequence;
        frame.sample_time_ns = static_cast<std::int64_t>(1e7 * static_cast<double>(frame.sequence + 1));
        frame.interval_s = measurement.interval_s;
        frame.axis_count = static_cast<std::uint8_t>(measurement.increment.size());
        frame.valid_mask = measurement.valid;
        for (std::size_t axis = 0; axis < measurement.increment.size(); ++axis)
            frame.increment[axis] = std::isfinite(measurement.increment[axis]) ? measurement.increment[axis] : 0;
        return monitor_->assess(frame);
    }

    void play_to(std::uint64_t sequence)
    {
        while (scene_->sequence() < sequence) next();
    }

    /// Between these frames after the onset the axis says so much more [deg/s].
    void shock(std::size_t axis, double deg_s, std::uint64_t frames)
    {
        scene_->spoil = [=](std::uint64_t sequence, FieldScene::Rates& rates) {
            if (sequence >= onset && sequence < onset + frames) rates[axis] += deg_s;
        };
    }

    std::optional<FieldScene> scene_;
    std::optional<FaultMonitor> monitor_;
};

TEST_F(FieldProvisional, exclusion_begins_before_the_shock_and_ends_half_a_second_after_the_last_contradiction)
{
    for (const std::size_t axis : {0U, 4U, 8U}) {
        SCOPED_TRACE("axis " + std::to_string(axis));
        begin(3, 20 + axis);
        shock(axis, 80, 8);
        play_to(onset);
        std::uint64_t first_out = 0;
        std::uint64_t last_out = 0;
        for (int frame = 0; frame < 300; ++frame) {
            const FaultVerdict& verdict = next();
            const AxisMask out = provisional_mask(verdict);
            ASSERT_EQ(verdict.isolated_mask, 0U);
            ASSERT_EQ(out & ~axes_of(axis / 3), 0U);
            if (out == 0) {
                ASSERT_EQ(state_of(verdict), VerdictState::healthy) << "frame " << verdict.sequence << ": neither before nor after";
                continue;
            }
            ASSERT_EQ(state_of(verdict), VerdictState::provisional);
            ASSERT_LE(verdict.excluded_from[axis], onset) << "contaminated frames stay in the attitude";
            ASSERT_GE(verdict.excluded_from[axis] + 10, onset);
            if (first_out == 0) first_out = verdict.sequence;
            last_out = verdict.sequence;
        }
        EXPECT_LE(first_out, onset + 6);
        // Windows that hold the shock contradict until it has left those of up to 0.4 s.
        EXPECT_GE(static_cast<double>(last_out - onset) * frame_s, 0.08 + 0.5 - 2 * frame_s);
        EXPECT_LE(static_cast<double>(last_out - onset) * frame_s, 0.08 + 0.4 + 0.5 + 0.1);
        EXPECT_EQ(state_of(monitor_->assess({})), VerdictState::healthy);
    }
}

TEST_F(FieldProvisional, exclusion_becomes_an_isolation_without_a_frame_in_between)
{
    begin(3, 31);
    scene_->spoil = [](std::uint64_t sequence, FieldScene::Rates& rates) {
        if (sequence >= onset) rates[4] += 10;
    };
    play_to(onset);
    bool was_out = false;
    for (int frame = 0; frame < 200; ++frame) {
        const FaultVerdict& verdict = next();
        const bool out = has_axis(verdict.excluded_from.mask(), 4);
        ASSERT_TRUE(out || !was_out) << "came back in between";
        was_out = out;
        ASSERT_TRUE(!was_out || verdict.excluded_from[4] <= onset);
    }
    EXPECT_EQ(monitor_->assess({}).isolated_mask, axes_of(1));
    const FaultDiagnosis diagnosis = monitor_->diagnosis();
    EXPECT_EQ(diagnosis_of(diagnosis, 4), Diagnosis::bias);
    EXPECT_NEAR(diagnosis.size[4] / degree, 10, 0.5);
    EXPECT_EQ(diagnosis.provisional_mask, 0U);
}

/// Blows of 40 deg/s for 0.1 s on one axis, this far apart. @returns what was latched within 15 s.
AxisMask latched_by_blows(FieldScene& scene, FaultMonitor& monitor, std::uint64_t frames_apart)
{
    scene.spoil = [=](std::uint64_t sequence, FieldScene::Rates& rates) {
        if (sequence >= onset && (sequence - onset) % frames_apart < 10) rates[6] += 40;
    };
    AxisMask latched = 0;
    while (scene.sequence() < onset + 1500) {
        const Measurement measurement = scene.next();
        SensorFrame frame;
        frame.epoch = 1;
        frame.sequence = measurement.identity.sequence;
        frame.interval_s = measurement.interval_s;
        frame.axis_count = 9;
        frame.valid_mask = measurement.valid;
        std::copy(measurement.increment.begin(), measurement.increment.end(), frame.increment.begin());
        latched |= monitor.assess(frame).isolated_mask;
    }
    return latched;
}

TEST_F(FieldProvisional, instrument_that_comes_and_goes_is_latched_as_erratic_and_one_that_rarely_does_is_not)
{
    begin(3, 41);
    EXPECT_EQ(latched_by_blows(*scene_, *monitor_, 120), axes_of(2)) << "12 times in 15 s";
    begin(3, 41);
    EXPECT_EQ(latched_by_blows(*scene_, *monitor_, 300), 0U) << "5 times in 15 s";
}

TEST_F(FieldProvisional, dropouts_of_one_two_and_all_instruments_are_never_latched)
{
    for (const std::size_t silent : {1U, 2U, 3U})
        for (const std::uint64_t frames : {2U, 11U, 40U, 200U}) {
            SCOPED_TRACE(std::to_string(silent) + " instruments for " + std::to_string(frames) + " frames");
            begin(3, 50 + frames);
            scene_->spoil = [=](std::uint64_t sequence, FieldScene::Rates& rates) {
                if (sequence < onset || sequence >= onset + frames) return;
                for (std::size_t axis = 0; axis < 3 * silent; ++axis) rates[axis] = std::nan("");
            };
            play_to(onset + frames + 100);
            AxisMask latched = 0;
            while (scene_->sequence() < onset + frames + 600) latched |= next().isolated_mask;
            EXPECT_EQ(latched, 0U);
            EXPECT_EQ(monitor_->diagnosis().absent_mask, 0U) << "back";
            EXPECT_EQ(state_of(next()), VerdictState::healthy);
        }
}

TEST_F(FieldProvisional, a_fault_after_a_dropout_is_still_found)
{
    begin(3, 61);
    scene_->spoil = [](std::uint64_t sequence, FieldScene::Rates& rates) {
        for (std::size_t axis = 0; sequence >= onset && sequence < onset + 40 && axis < 3; ++axis) rates[axis] = std::nan("");
        if (sequence >= onset + 400) rates[1] -= 20;
    };
    play_to(onset + 400);
    EXPECT_EQ(next().isolated_mask, 0U);
    play_to(onset + 500);
    EXPECT_EQ(next().isolated_mask, axes_of(0));
}

}  // namespace
}  // namespace quorient::fdi
