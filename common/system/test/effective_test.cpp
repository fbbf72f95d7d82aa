#include "files.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <set>

namespace quorient::system {

namespace {

using testing::HasSubstr;
using testing::Not;

const std::string configurations = QUORIENT_SOURCE_DIR "/deploy/configurations";

/// What two systems must have in common beyond their configurations' text.
void expect_same(const System& a, const System& b)
{
    EXPECT_EQ(a.name, b.name);
    EXPECT_EQ(a.unit, b.unit);
    EXPECT_EQ(a.interval_s, b.interval_s);
    EXPECT_EQ(a.channels, b.channels);
    EXPECT_EQ(a.sensor.consumers, b.sensor.consumers);
    EXPECT_EQ(a.sensor.initial_attitude, b.sensor.initial_attitude);
    EXPECT_EQ(a.sensor.levelled_heading_rad, b.sensor.levelled_heading_rad);
    EXPECT_EQ(a.sensor.process.bus.peers, b.sensor.process.bus.peers);
    ASSERT_EQ(a.sensor.cluster.has_value(), b.sensor.cluster.has_value());
    if (a.sensor.cluster) {
        EXPECT_EQ(a.sensor.cluster->axes, b.sensor.cluster->axes);
        EXPECT_EQ(a.sensor.cluster->sigma, b.sensor.cluster->sigma);
        EXPECT_EQ(a.sensor.cluster->range, b.sensor.cluster->range);
    }
    ASSERT_EQ(a.lanes.size(), b.lanes.size());
    for (std::size_t i = 0; i < a.lanes.size(); ++i) {
        EXPECT_EQ(a.lanes[i].name, b.lanes[i].name);
        EXPECT_EQ(a.lanes[i].detector.process.bus.vendor, b.lanes[i].detector.process.bus.vendor);
        EXPECT_EQ(a.lanes[i].detector.process.bus.transport, b.lanes[i].detector.process.bus.transport);
        EXPECT_EQ(a.lanes[i].detector.process.node.service, b.lanes[i].detector.process.node.service);
        EXPECT_EQ(a.lanes[i].detector.detection.method, b.lanes[i].detector.detection.method);
        EXPECT_EQ(a.lanes[i].detector.detection.tolerance, b.lanes[i].detector.detection.tolerance);
        EXPECT_EQ(a.lanes[i].detector.detection.pfa, b.lanes[i].detector.detection.pfa);
        EXPECT_EQ(a.lanes[i].detector.detection.sensor_class, b.lanes[i].detector.detection.sensor_class);
        EXPECT_EQ(a.lanes[i].detector.detection.mount, b.lanes[i].detector.detection.mount);
        EXPECT_EQ(a.lanes[i].detector.detection.delay_class_s, b.lanes[i].detector.detection.delay_class_s);
        EXPECT_EQ(a.lanes[i].detector.detection.bare, b.lanes[i].detector.detection.bare);
        EXPECT_EQ(a.lanes[i].integrator.integration.algorithm, b.lanes[i].integrator.integration.algorithm);
        ASSERT_EQ(a.lanes[i].detector.observers.has_value(), b.lanes[i].detector.observers.has_value());
        if (a.lanes[i].detector.observers) {
            EXPECT_EQ(a.lanes[i].detector.observers->poles, b.lanes[i].detector.observers->poles);
            EXPECT_EQ(a.lanes[i].detector.observers->plant.a, b.lanes[i].detector.observers->plant.a);
            EXPECT_EQ(a.lanes[i].detector.observers->sigma, b.lanes[i].detector.observers->sigma);
        }
    }
    ASSERT_EQ(a.voters.size(), b.voters.size());
    for (std::size_t i = 0; i < a.voters.size(); ++i) {
        EXPECT_EQ(a.voters[i].process.bus.vendor, b.voters[i].process.bus.vendor);
        EXPECT_EQ(a.voters[i].voting.lease_s, b.voters[i].voting.lease_s);
        EXPECT_EQ(a.voters[i].ros2.has_value(), b.voters[i].ros2.has_value());
    }
    EXPECT_EQ(a.sensor.process.node.orders.inject, b.sensor.process.node.orders.inject);
    ASSERT_EQ(a.web_monitor.has_value(), b.web_monitor.has_value());
    if (a.web_monitor) {
        EXPECT_EQ(a.web_monitor->process.node.name, b.web_monitor->process.node.name);
        EXPECT_EQ(a.web_monitor->process.realtime.priority, b.web_monitor->process.realtime.priority);
        EXPECT_EQ(a.web_monitor->process.bus.transport, b.web_monitor->process.bus.transport);
        EXPECT_EQ(a.web_monitor->port, b.web_monitor->port);
        EXPECT_EQ(a.web_monitor->allow_orders, b.web_monitor->allow_orders);
        EXPECT_EQ(a.web_monitor->token_file, b.web_monitor->token_file);
    }
    EXPECT_EQ(a.expectations.isolated, b.expectations.isolated);
    EXPECT_EQ(a.expectations.final_error_rad, b.expectations.final_error_rad);
}

/// What check prints of a system must read back to the same, wherever it is kept.
void expect_reads_back(const System& system, const Overrides& overrides)
{
    const TemporaryFile file(system.configuration, "effective.yaml");
    const auto again = load(file.name(), overrides);
    ASSERT_TRUE(again) << again.error() << "\n" << system.configuration;
    EXPECT_EQ(again->configuration, system.configuration);
    expect_same(system, *again);
}

}  // namespace

TEST(EffectiveConfiguration, of_every_example_reads_back_to_the_same_system)
{
    const Overrides overrides{.any_host = true};
    std::size_t count = 0;
    for (const auto& entry : std::filesystem::directory_iterator(configurations)) {
        if (entry.path().extension() != ".yaml") continue;
        const auto system = load(entry.path().string(), overrides);
        ASSERT_TRUE(system) << system.error();
        expect_reads_back(*system, overrides);
        ++count;
    }
    EXPECT_GE(count, 5U);
}

TEST(EffectiveConfiguration, of_every_kind_of_unit_and_source_reads_back_to_the_same_system)
{
    for (const auto& text : {simulation_file, log_file, ros2_file, accelerometer_file, vessel_file}) {
        const auto system = loaded(text);
        ASSERT_TRUE(system) << system.error();
        expect_reads_back(*system, {});
    }
}

TEST(EffectiveConfiguration, of_a_file_full_of_settings_reads_back_to_the_same_system)
{
    const std::string full =
        "name: 'a: #1'\n"
        "domain: 9\n"
        "dds: fastdds\n"
        "peers: [127.0.0.1]\n"
        "priority: 0\n"
        "unit: {id: 3, name: 'null', axes: [[0.26726124191242438, 0.53452248382484879, 0.80178372573727319], [0, 1, 0], [0, 0, 1], [1, 0, "
        "0]],\n"
        "       range_deg_s: 300, initial_attitude: {roll_deg: 1, pitch_deg: 2, yaw_deg: 3}}\n"
        "source: {rate_hz: 123.4, quantum_rad: 3.0e-7, noise_rad: 1.0e-7, seed: 18446744073709551615, speed: 0.1,\n"
        "         motion: {kind: random, bandwidth_hz: 1.5}, faults: ['axis=1+2,kind=scale,value=0.8,start=8,end=18', "
        "'axis=0,kind=zero']}\n"
        "lanes:\n"
        "  - {name: a, dds: cyclonedds, peers: [], detector: {method: vector, tolerance: 1.0e-5}, integrator: {algorithm: single}}\n"
        "  - {name: b, processors: [0], detector: {class: tactical, mount: structure, delay_class_s: 0.002, bare: true}}\n"
        "commands: {inject: refused}\n"
        "monitor: {name: page, port: 0, priority: 3, allow_orders: true}\n"
        "voting: {patience: 0.7, listen_s: 0, level_window: 32}\n"
        "voters: [{name: 'true', dds: cyclonedds}, {}]\n"
        "ros2: {imu: /x/imu, every: 2, stamp: sample}\n"
        "expect: {isolated: [], within_frames: 0, no_gap: true}\n";
    const auto system = loaded(full);
    ASSERT_TRUE(system) << system.error();
    EXPECT_EQ(system->sensor.source.scenario.seed, 18446744073709551615U);
    EXPECT_TRUE(system->lanes[0].detector.process.bus.peers.empty()) << "its own list, in place of the whole file's";
    expect_reads_back(*system, {});
}

TEST(EffectiveConfiguration, holds_what_the_command_line_set)
{
    const auto system =
        loaded(simulation_file, {.dds = Vendor::fastdds, .domain = 11, .set = {"lanes.b.detector.margin=4", "source.speed=3"}});
    ASSERT_TRUE(system) << system.error();
    EXPECT_THAT(system->configuration, HasSubstr("domain: 11\n"));
    EXPECT_THAT(system->configuration, HasSubstr("dds: fastdds\n"));
    EXPECT_THAT(system->configuration, HasSubstr("margin: 4\n"));
    EXPECT_THAT(system->configuration, HasSubstr("speed: 3\n"));
    expect_reads_back(*system, {});
}

TEST(EffectiveConfiguration, states_what_the_file_left_open)
{
    const auto system = loaded(simulation_file);
    ASSERT_TRUE(system) << system.error();
    for (const char* line : {"rate_hz: 200", "quantize: none", "method: glt", "algorithm: window-10", "patience: 0.2", "lease_s: 0.05",
                             "listen_s: 2", "disagreement_frames: 3", "interface: lo", "name: unit 1"})
        EXPECT_THAT(system->configuration, HasSubstr(line));
}

TEST(Reference, page_is_the_one_in_the_documentation)
{
    std::ifstream file(QUORIENT_SOURCE_DIR "/docs/system-file.md");
    const std::string text{std::istreambuf_iterator<char>(file), {}};
    EXPECT_TRUE(text == reference_page()) << "stale: quorient check --reference > docs/system-file.md";
}

}  // namespace quorient::system
