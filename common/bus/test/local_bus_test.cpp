#include "quorient/bus/local_bus.hpp"

#include <gtest/gtest.h>

namespace quorient::bus {

namespace {

SensorFrame frame(std::uint64_t sequence)
{
    SensorFrame frame;
    frame.sequence = sequence;
    return frame;
}

TEST(LocalBus, delivers_in_the_order_of_writing)
{
    LocalHub hub;
    const auto one = hub.open();
    const auto other = hub.open();
    auto subscription = other->subscribe(topics::frame);
    auto publisher = one->advertise(topics::frame);
    for (std::uint64_t i = 0; i < 5; ++i) publisher.publish(frame(i));

    SensorFrame received;
    for (std::uint64_t i = 0; i < 5; ++i) {
        ASSERT_TRUE(subscription.take(received));
        EXPECT_EQ(received.sequence, i);
    }
    EXPECT_FALSE(subscription.take(received));
}

TEST(LocalBus, keeps_the_newest_where_nobody_takes)
{
    LocalHub hub;
    const auto bus = hub.open();
    auto subscription = bus->subscribe(topics::frame);
    auto publisher = bus->advertise(topics::frame);
    for (std::uint64_t i = 0; i < 70; ++i) publisher.publish(frame(i));

    SensorFrame received;
    ASSERT_TRUE(subscription.take(received));
    EXPECT_EQ(received.sequence, 6U);
}

TEST(LocalBus, keeps_the_newest_of_each_writer)
{
    LocalHub hub;
    const auto bus = hub.open();
    auto subscription = bus->subscribe(topics::diagnosis);  // depth 1
    auto first = bus->advertise(topics::diagnosis);
    auto second = bus->advertise(topics::diagnosis);
    FaultDiagnosis sent;
    for (sent.sequence = 1; sent.sequence <= 3; ++sent.sequence) {
        sent.detector = 1;
        first.publish(sent);
        sent.detector = 2;
        second.publish(sent);
    }

    FaultDiagnosis received;
    for (const std::uint32_t detector : {1U, 2U}) {
        ASSERT_TRUE(subscription.take(received));
        EXPECT_EQ(received.detector, detector);
        EXPECT_EQ(received.sequence, 3U);
    }
    EXPECT_FALSE(subscription.take(received));
}

TEST(LocalBus, gives_a_late_joiner_the_history_of_latched_topics_only)
{
    LocalHub hub;
    const auto bus = hub.open();
    auto frames = bus->advertise(topics::frame);
    auto verdicts = bus->advertise(topics::verdict);
    frames.publish(frame(1));
    verdicts.publish(FaultVerdict{});

    auto late_frames = bus->subscribe(topics::frame);
    auto late_verdicts = bus->subscribe(topics::verdict);
    SensorFrame received_frame;
    FaultVerdict received_verdict;
    EXPECT_FALSE(late_frames.take(received_frame));
    EXPECT_TRUE(late_verdicts.take(received_verdict));
}

TEST(LocalBus, tells_who_is_matched)
{
    LocalHub hub;
    const auto bus = hub.open();
    auto publisher = bus->advertise(topics::frame);
    EXPECT_EQ(publisher.status().matched, 0U);
    {
        const auto subscription = bus->subscribe(topics::frame);
        EXPECT_EQ(publisher.status().matched, 1U);
    }
    EXPECT_EQ(publisher.status().matched, 0U);
}

}  // namespace

}  // namespace quorient::bus
