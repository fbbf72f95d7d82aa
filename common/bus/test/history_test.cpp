#include "quorient/bus/history.hpp"
#include "quorient/bus/topics.hpp"

#include <gtest/gtest.h>

namespace quorient::bus {

namespace {

Settings at(double rate_hz, const char* interface = "lo")
{
    Settings settings;
    settings.interface = interface;
    settings.heartbeat_s = 0.5 / rate_hz;
    return settings;
}

TEST(KeptSamples, of_an_exclusive_writer_on_loopback_span_one_lease)
{
    EXPECT_EQ(kept_samples(topics::voted.spec.qos, {.lease_s = 0.05}, at(200)), 10);
    EXPECT_EQ(kept_samples(topics::voted.spec.qos, {.lease_s = 0.05}, at(1000)), 50);
    EXPECT_EQ(kept_samples(topics::voted.spec.qos, {.lease_s = 0.06}, at(50)), 3);
}

TEST(KeptSamples, are_at_least_one_and_at_most_the_depth_of_the_topic)
{
    EXPECT_EQ(kept_samples(topics::voted.spec.qos, {.lease_s = 0.05}, at(1)), 1);
    EXPECT_EQ(kept_samples(topics::voted.spec.qos, {.lease_s = 10}, at(1000)), topics::voted.spec.qos.depth);
}

TEST(KeptSamples, of_all_other_writers_and_on_a_network_are_the_depth_of_the_topic)
{
    EXPECT_EQ(kept_samples(topics::frame.spec.qos, {.lease_s = 0.05}, at(200)), topics::frame.spec.qos.depth);
    EXPECT_EQ(kept_samples(topics::voted.spec.qos, {.lease_s = 0.05}, at(200, "198.18.10.1")), topics::voted.spec.qos.depth);
}

}  // namespace

}  // namespace quorient::bus
