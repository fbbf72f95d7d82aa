// What ends a bus's wait, and what does not.

#include "pairs_scene.hpp"

#include <gtest/gtest.h>
#include <chrono>
#include <string>

namespace quorient::bus {

namespace {

using Clock = std::chrono::steady_clock;
constexpr std::int64_t short_wait_ns = 20'000'000, long_wait_ns = 5'000'000'000;
constexpr int samples = 20;  // fewer than the topic's depth: DDS loses none of them

class Wait : public testing::TestWithParam<Vendor> {
protected:
    void match(Subscription<FaultVerdict>& subscription)
    {
        ASSERT_TRUE(eventually(*bus, [&] { return publisher.status().matched == 1 && subscription.status().matched == 1; }));
    }

    /// Sends a sample and waits. @returns whether the wait ended before its time.
    bool is_woken(std::int64_t timeout_ns)
    {
        publisher.publish(FaultVerdict{});
        const auto begin = Clock::now();
        bus->wait(timeout_ns);
        return Clock::now() - begin < std::chrono::nanoseconds{timeout_ns} * 3 / 4;
    }

    static int taken(Subscription<FaultVerdict>& subscription)
    {
        FaultVerdict verdict;
        int count = 0;
        while (subscription.take(verdict)) ++count;
        return count;
    }

    std::unique_ptr<Bus> bus = open_on_loopback(GetParam()), other = open_on_loopback(GetParam());
    Publisher<FaultVerdict> publisher = other->advertise(topics::verdict);
};

TEST_P(Wait, ends_with_a_sample)
{
    auto subscription = bus->subscribe(topics::verdict);
    match(subscription);
    int received = 0;
    for (int sample = 0; sample < samples; ++sample) {
        EXPECT_TRUE(is_woken(long_wait_ns));
        received += taken(subscription);
    }
    EXPECT_TRUE(eventually(*bus, [&] { return (received += taken(subscription)) >= samples; }));
    EXPECT_EQ(received, samples);
}

TEST_P(Wait, does_not_end_with_a_sample_that_can_come_with_others_and_loses_none)
{
    auto urgent = bus->subscribe(topics::attitude);
    auto subscription = bus->subscribe(topics::verdict, {.wake = Wake::with_others});
    match(subscription);
    int woken = 0;
    for (int sample = 0; sample < samples; ++sample) woken += is_woken(short_wait_ns) ? 1 : 0;
    EXPECT_LT(woken, samples / 4);  // a wait may return early

    auto urgent_publisher = other->advertise(topics::attitude);
    AttitudeState attitude;
    ASSERT_TRUE(eventually(*bus, [&] { return urgent_publisher.publish(AttitudeState{}) && urgent.take(attitude); }));
    int received = 0;
    EXPECT_TRUE(eventually(*bus, [&] { return (received += taken(subscription)) >= samples; }));
    EXPECT_EQ(received, samples);
}

INSTANTIATE_TEST_SUITE_P(Loopback, Wait, testing::Values(Vendor::fastdds, Vendor::cyclonedds),
                         [](const auto& vendor) { return std::string{to_string(vendor.param)}; });

}  // namespace

}  // namespace quorient::bus
