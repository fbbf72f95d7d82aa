#include "observer_scene.hpp"
#include "quorient/fdi/fault_monitor.hpp"

#include <gtest/gtest.h>

using namespace quorient;
using namespace quorient::fdi;
using namespace quorient::fdi::test;

namespace {

/// What the monitor came to hold of the channels, and when.
struct Change {
    double time_s;
    AxisMask isolated;
};

FaultMonitor monitor_of(ObserverScheme scheme, double readmit_after_s)
{
    ObserverSettings settings = paper_settings(scheme);
    settings.threshold.reset();
    settings.sigma = {2e-4};
    return FaultMonitor::make(ObserverDetector::make(settings, 0.01).value(), {.readmit_after_s = readmit_after_s}, 2).value();
}

/// @param spoil  (time, samples, rudder) may change what the sensors and the rudder say.
template <class Spoil>
std::vector<Change> changes(const PaperRun& run, FaultMonitor monitor, Spoil spoil)
{
    std::vector<Change> all;
    SensorFrame frame;
    AxisMask isolated = 0;
    run.play([&](double time, const Eigen::VectorXd&, const Eigen::VectorXd& sample, double rudder) {
        Eigen::VectorXd measured = sample;
        spoil(time, measured, rudder);
        frame.interval_s = run.interval_s;
        frame.valid_mask = 0b11;
        frame.known_input[0] = rudder;
        frame.increment[0] = measured(0) * run.interval_s;
        frame.increment[1] = measured(1) * run.interval_s;
        const AxisMask now = monitor.assess(frame).isolated_mask;
        if (now != isolated) all.push_back({time, now});
        isolated = now;
        ++frame.sequence;
    });
    return all;
}

constexpr auto as_it_is = [](double, Eigen::VectorXd&, double&) {};

}  // namespace

TEST(ObserverReadmission, trusts_a_channel_again_once_its_fault_is_over)
{
    for (const auto scheme : {ObserverScheme::blind, ObserverScheme::directional}) {
        for (unsigned seed = 1; seed <= 5; ++seed) {
            PaperRun run;
            run.noise = 2e-4;
            run.seed = seed;
            const auto seen = changes(run, monitor_of(scheme, 2), as_it_is);
            ASSERT_EQ(seen.size(), 4U) << to_string(scheme) << " seed " << seed;
            EXPECT_EQ(seen[0].isolated, 0b10U);
            EXPECT_TRUE(seen[0].time_s >= 20 && seen[0].time_s < 25) << seen[0].time_s;
            EXPECT_EQ(seen[1].isolated, 0U);
            EXPECT_TRUE(seen[1].time_s >= 32 && seen[1].time_s < 48) << seen[1].time_s;
            EXPECT_EQ(seen[2].isolated, 0b01U);
            EXPECT_TRUE(seen[2].time_s >= 50 && seen[2].time_s < 55) << seen[2].time_s;
            EXPECT_EQ(seen[3].isolated, 0U);
            EXPECT_GE(seen[3].time_s, 72);
        }
    }
}

TEST(VesselMonitor, names_the_right_channel_where_it_starts_beside_a_fault)
{
    for (const auto scheme : {ObserverScheme::blind, ObserverScheme::directional}) {
        for (const int faulty : {0, 1}) {
            PaperRun run;
            run.noise = 2e-4;
            run.gyro_fault = run.accelerometer_fault = 0;
            const auto seen =
                changes(run, monitor_of(scheme, 100), [&](double, Eigen::VectorXd& sample, double&) { sample(faulty) += 0.01; });
            ASSERT_EQ(seen.size(), 1U) << to_string(scheme) << ", channel " << faulty;
            EXPECT_EQ(seen[0].isolated, axis_bit(static_cast<std::size_t>(faulty))) << to_string(scheme);
            EXPECT_LT(seen[0].time_s, 3);
        }
    }
}

TEST(VesselMonitor, dates_a_fault_from_its_first_alarm)
{
    for (const auto scheme : {ObserverScheme::blind, ObserverScheme::directional}) {
        for (unsigned seed = 1; seed <= 5; ++seed) {
            auto monitor = monitor_of(scheme, 100);
            PaperRun run;
            run.noise = 2e-4;
            run.seed = seed;
            SensorFrame frame;
            std::uint64_t onset = never;
            run.play([&](double, const Eigen::VectorXd&, const Eigen::VectorXd& sample, double rudder) {
                frame.interval_s = run.interval_s;
                frame.valid_mask = 0b11;
                frame.known_input[0] = rudder;
                for (const std::size_t channel : {std::size_t{0}, std::size_t{1}})
                    frame.increment[channel] = sample(static_cast<Eigen::Index>(channel)) * run.interval_s;
                onset = std::min(onset, monitor.assess(frame).excluded_from[1]);
                ++frame.sequence;
            });
            EXPECT_NEAR(static_cast<double>(onset), 2000, 2) << to_string(scheme) << " seed " << seed;
        }
    }
}

TEST(ObserverReadmission, never_trusts_a_channel_while_its_fault_lasts)
{
    for (const auto scheme : {ObserverScheme::blind, ObserverScheme::directional}) {
        PaperRun run;
        run.noise = 2e-4;
        run.gyro_fault = run.accelerometer_fault = 0;
        const auto seen = changes(run, monitor_of(scheme, 0.1), [](double time, Eigen::VectorXd& sample, double&) {
            if (time >= 20) sample(1) += 0.01;
        });
        ASSERT_EQ(seen.size(), 1U) << to_string(scheme);
        EXPECT_EQ(seen[0].isolated, 0b10U);
    }
}

TEST(ObserverReadmission, earns_nothing_at_rest)
{
    const auto with_a_dead_gyro_from_5_s = [](double amplitude_later) {
        PaperRun run;
        run.gyro_fault = run.accelerometer_fault = 0;
        run.rudder_rad = 0.1;
        const auto monitor = [] { return monitor_of(ObserverScheme::blind, 2); };
        // The vessel comes to rest: everything that moved it is gone, and a sensor that says 0 is right by chance.
        return changes(run, monitor(), [&](double time, Eigen::VectorXd& sample, double& rudder) {
            if (time >= 5) sample(1) = 0;
            if (time < 10) return;
            sample *= amplitude_later;
            rudder *= amplitude_later;
        });
    };
    const auto seen = with_a_dead_gyro_from_5_s(0);
    ASSERT_GE(seen.size(), 1U);
    EXPECT_EQ(seen.front().isolated, 0b10U);
    for (const Change& change : seen) EXPECT_NE(change.isolated & 0b10U, 0U) << "readmitted at rest, " << change.time_s << " s";
}

TEST(ObserverDetector, blames_nobody_when_the_observers_start_again_beside_an_excluded_channel)
{
    for (const auto scheme : {ObserverScheme::blind, ObserverScheme::directional}) {
        PaperRun run;
        run.noise = 2e-4;
        run.accelerometer_fault = 0;
        const auto seen = changes(run, monitor_of(scheme, 100), [](double time, Eigen::VectorXd&, double& rudder) {
            if (time >= 24 && time < 25) rudder = std::nan("");
        });
        ASSERT_EQ(seen.size(), 1U) << to_string(scheme);
        EXPECT_EQ(seen[0].isolated, 0b10U);
    }
}
