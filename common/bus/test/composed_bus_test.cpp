// Services of one process on a composed bus, beside other processes of either vendor.

#include "quorient/bus/composed_bus.hpp"

#include <gtest/gtest.h>
#include <unistd.h>
#include <chrono>
#include <map>
#include <string>
#include <tuple>
#include <vector>

namespace quorient::bus {

namespace {

using Clock = std::chrono::steady_clock;
constexpr auto patience = std::chrono::seconds{20};
constexpr std::uint64_t samples = 50;  // fewer than the topic's depth: DDS loses none of them

enum Source : std::uint32_t { inside = 1, beside = 2, outside = 3 };

Settings on_loopback(Vendor vendor)
{
    Settings settings;
    settings.vendor = vendor;
    settings.domain = 100 + static_cast<std::uint32_t>(::getpid() % 100);
    settings.participant = "test";
    settings.voted_lease_s = 2;  // more than the writers offer
    return settings;
}

std::unique_ptr<Bus> opened(tl::expected<std::unique_ptr<Bus>, std::string> bus)
{
    if (!bus) throw Error(bus.error());
    return std::move(*bus);
}

FaultVerdict verdict_of(Source source, std::uint64_t sequence)
{
    FaultVerdict verdict;
    verdict.epoch = 1;
    verdict.sequence = sequence;
    verdict.unit = 1;
    verdict.detector = source;
    return verdict;
}

/// What a subscriber has received, by the verdicts' detector.
class Received {
public:
    explicit Received(Subscription<FaultVerdict>& subscription) : subscription_(subscription) {}

    void take_all()
    {
        FaultVerdict verdict;
        while (subscription_.take(verdict)) sequences_[verdict.detector].push_back(verdict.sequence);
    }

    bool has_last_of(Source source) const
    {
        const auto found = sequences_.find(source);
        return found != sequences_.end() && found->second.back() == samples;
    }

    const std::vector<std::uint64_t>& of(Source source) { return sequences_[source]; }

private:
    Subscription<FaultVerdict>& subscription_;
    std::map<std::uint32_t, std::vector<std::uint64_t>> sequences_;
};

std::vector<std::uint64_t> each_once(std::uint64_t last = samples)
{
    std::vector<std::uint64_t> all;
    for (std::uint64_t sequence = 1; sequence <= last; ++sequence) all.push_back(sequence);
    return all;
}

class ComposedBus : public testing::TestWithParam<std::tuple<Vendor, Vendor>> {
protected:
    /// Polls until the condition holds, each time as a new round of the composed bus; waits on the other bus, not on the clock.
    template <class Condition>
    bool eventually(Condition condition)
    {
        const auto deadline = Clock::now() + patience;
        while (!condition()) {
            if (Clock::now() > deadline) return false;
            composed->flush();
            other->wait(1'000'000);
        }
        return true;
    }

    std::unique_ptr<Bus> composed = opened(open_composed(on_loopback(std::get<0>(GetParam()))));
    std::unique_ptr<Bus> other = opened(open(on_loopback(std::get<1>(GetParam()))));
};

TEST_P(ComposedBus, gives_every_subscriber_every_sample_once_inside_and_outside)
{
    auto publisher = composed->advertise(topics::verdict);
    auto second_publisher = composed->advertise(topics::verdict);
    auto far_publisher = other->advertise(topics::verdict);
    auto first = composed->subscribe(topics::verdict);
    auto second = composed->subscribe(topics::verdict);
    auto far = other->subscribe(topics::verdict);
    // Two writers inside, one outside: both readers inside count three, as if every service had a process of its own.
    ASSERT_TRUE(eventually([&] { return first.status().matched == 3 && second.status().matched == 3 && far.status().matched == 3; }));
    ASSERT_TRUE(eventually([&] { return publisher.status().matched == 3 && far_publisher.status().matched >= 2; }));

    Received in_first(first), in_second(second), in_far(far);
    const auto take_all = [&] {
        in_first.take_all();
        in_second.take_all();
        in_far.take_all();
    };
    for (std::uint64_t sequence = 1; sequence <= samples; ++sequence) {
        ASSERT_TRUE(publisher.publish(verdict_of(inside, sequence)));
        ASSERT_TRUE(far_publisher.publish(verdict_of(outside, sequence)));
        ASSERT_TRUE(second_publisher.publish(verdict_of(beside, sequence)));
        if (sequence % 3 == 0) take_all();
    }
    ASSERT_TRUE(eventually([&] {
        take_all();
        return in_far.has_last_of(inside) && in_far.has_last_of(beside) && in_first.has_last_of(outside) && in_second.has_last_of(outside);
    }));
    // What is sent after all of that arrives after any second copy of it would have.
    ASSERT_TRUE(publisher.publish(verdict_of(inside, samples + 1)));
    ASSERT_TRUE(far_publisher.publish(verdict_of(outside, samples + 1)));
    ASSERT_TRUE(eventually([&] {
        take_all();
        return in_far.of(inside).back() > samples && in_first.of(outside).back() > samples && in_second.of(outside).back() > samples;
    }));
    for (auto* received : {&in_first, &in_second, &in_far}) {
        EXPECT_EQ(received->of(inside), each_once(samples + 1));
        EXPECT_EQ(received->of(beside), each_once());
        EXPECT_EQ(received->of(outside), each_once(samples + 1));
    }
}

TEST_P(ComposedBus, gives_a_subscriber_of_this_process_nothing_from_outside)
{
    auto publisher = composed->advertise(topics::verdict);
    auto far_publisher = other->advertise(topics::verdict);
    auto inner = composed->subscribe(topics::verdict, {.reach = Reach::process});
    auto anywhere = composed->subscribe(topics::verdict);
    ASSERT_TRUE(eventually([&] { return anywhere.status().matched == 2 && far_publisher.status().matched == 1; }));
    EXPECT_EQ(inner.status().matched, 1U);

    Received in_inner(inner), in_anywhere(anywhere);
    for (std::uint64_t sequence = 1; sequence <= samples; ++sequence) {
        ASSERT_TRUE(far_publisher.publish(verdict_of(outside, sequence)));
        ASSERT_TRUE(publisher.publish(verdict_of(inside, sequence)));
    }
    ASSERT_TRUE(eventually([&] {
        in_inner.take_all();
        in_anywhere.take_all();
        return in_anywhere.has_last_of(outside);
    }));
    EXPECT_EQ(in_inner.of(inside), each_once());
    EXPECT_TRUE(in_inner.of(outside).empty());
}

TEST_P(ComposedBus, gives_a_late_subscriber_the_history_once)
{
    auto publisher = composed->advertise(topics::verdict);
    auto far_publisher = other->advertise(topics::verdict);
    auto early = composed->subscribe(topics::verdict);
    Received in_early(early);
    for (std::uint64_t sequence = 1; sequence <= samples; ++sequence) {
        ASSERT_TRUE(publisher.publish(verdict_of(inside, sequence)));
        ASSERT_TRUE(far_publisher.publish(verdict_of(outside, sequence)));
    }
    ASSERT_TRUE(eventually([&] {
        in_early.take_all();
        return in_early.has_last_of(outside);
    }));

    auto late = composed->subscribe(topics::verdict);
    auto far = other->subscribe(topics::verdict);
    Received in_late(late), in_far(far);
    ASSERT_TRUE(eventually([&] {
        in_early.take_all();
        in_late.take_all();
        in_far.take_all();
        return in_late.has_last_of(outside) && in_far.has_last_of(inside);
    }));
    for (auto* received : {&in_early, &in_late}) {
        EXPECT_EQ(received->of(inside), each_once());
        EXPECT_EQ(received->of(outside), each_once());
    }
    EXPECT_EQ(in_far.of(inside), each_once());
}

TEST_P(ComposedBus, leaves_the_choice_of_the_owner_to_the_vendor)
{
    auto weak = composed->advertise(topics::voted, {.strength = 1, .lease_s = 1});
    auto strong = other->advertise(topics::voted, {.strength = 2, .lease_s = 1});
    auto subscription = composed->subscribe(topics::voted);
    ASSERT_TRUE(eventually([&] { return subscription.status().matched == 2 && strong.status().matched == 1 && weak.status().matched == 1; }));
    const auto voted_by = [](std::uint32_t voter, std::uint64_t sequence) {
        VotedAttitude voted;
        voted.unit = 1;
        voted.voter = voter;
        voted.sequence = sequence;
        return voted;
    };
    VotedAttitude voted;
    ASSERT_TRUE(strong.publish(voted_by(2, 1)));
    ASSERT_TRUE(eventually([&] { return subscription.take(voted); }));
    ASSERT_TRUE(weak.publish(voted_by(1, 2)));
    ASSERT_TRUE(strong.publish(voted_by(2, 2)));
    ASSERT_TRUE(eventually([&] { return subscription.take(voted); }));
    EXPECT_EQ(voted.voter, 2U);
    EXPECT_EQ(voted.sequence, 2U);
}

TEST_P(ComposedBus, does_not_wait_while_a_sample_waits_inside)
{
    auto publisher = composed->advertise(topics::attitude);
    auto subscription = composed->subscribe(topics::attitude);
    ASSERT_TRUE(publisher.publish(AttitudeState{}));
    const auto start = Clock::now();
    composed->wait(std::chrono::nanoseconds{patience}.count());
    EXPECT_LT(Clock::now() - start, patience / 2);
    AttitudeState attitude;
    EXPECT_TRUE(subscription.take(attitude));
    EXPECT_FALSE(subscription.take(attitude));
}

INSTANTIATE_TEST_SUITE_P(Loopback, ComposedBus,
                         testing::Combine(testing::Values(Vendor::fastdds, Vendor::cyclonedds),
                                          testing::Values(Vendor::fastdds, Vendor::cyclonedds)),
                         [](const auto& pair) {
                             return std::string{to_string(std::get<0>(pair.param))} + "_beside_" +
                                    std::string{to_string(std::get<1>(pair.param))};
                         });

TEST(ComposedBusSettings, need_a_vendor)
{
    EXPECT_FALSE(open_composed(on_loopback(Vendor::local)));
}

}  // namespace

}  // namespace quorient::bus
