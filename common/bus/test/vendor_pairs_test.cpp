// Every type, written by either vendor and read by either, field by field.

#include "pairs_scene.hpp"
#include "random_message.hpp"

#include <gtest/gtest.h>
#include <unistd.h>
#include <chrono>
#include <tuple>

namespace quorient::bus {

namespace {

using Clock = std::chrono::steady_clock;

class VendorPairs : public testing::TestWithParam<std::tuple<Vendor, Vendor>> {};

template <class Message>
void expect_same_fields(const Message& sent, const Message& received, const char* topic)
{
    std::apply(
        [&](const auto&... field) {
            ([&] { EXPECT_EQ(sent.*(field.member), received.*(field.member)) << topic << "." << field.name; }(), ...);
        },
        Fields<Message>::all);
}

TEST_P(VendorPairs, carry_every_type_field_by_field)
{
    const auto [writing, reading] = GetParam();
    const auto writer_bus = open_on_loopback(writing);
    const auto reader_bus = open_on_loopback(reading);
    const auto seed = static_cast<std::uint64_t>(::getpid());
    SCOPED_TRACE(testing::Message() << "seed " << seed);
    std::mt19937_64 random{seed};

    const auto carry = [&](const auto& topic) {
        using Message = typename std::decay_t<decltype(topic)>::Message;
        auto publisher = writer_bus->advertise(topic);
        auto subscription = reader_bus->subscribe(topic);
        ASSERT_TRUE(eventually(*reader_bus, [&] { return publisher.status().matched > 0 && subscription.status().matched > 0; }))
            << topic.spec.name << ": no match";
        for (int round = 0; round < 3; ++round) {
            const auto sent = random_message<Message>(random);
            Message received;
            // A best-effort sample may be lost once; then it is sent again.
            bool arrived = false;
            for (int attempt = 0; attempt < 3 && !arrived; ++attempt) {
                ASSERT_TRUE(publisher.publish(sent));
                arrived = eventually(*reader_bus, [&] { return subscription.take(received); });
            }
            ASSERT_TRUE(arrived) << topic.spec.name << ": nothing received";
            expect_same_fields(sent, received, topic.spec.name);
        }
    };
    std::apply([&](const auto&... topic) { (carry(topic), ...); }, topics::all);
}

INSTANTIATE_TEST_SUITE_P(Loopback, VendorPairs,
                         testing::Combine(testing::Values(Vendor::fastdds, Vendor::cyclonedds),
                                          testing::Values(Vendor::fastdds, Vendor::cyclonedds)),
                         [](const auto& pair) {
                             return std::string{to_string(std::get<0>(pair.param))} + "_to_" +
                                    std::string{to_string(std::get<1>(pair.param))};
                         });

TEST_P(VendorPairs, report_a_reader_that_asks_for_another_ownership)
{
    const auto [writing, reading] = GetParam();
    const auto writer_bus = open_on_loopback(writing);
    const auto reader_bus = open_on_loopback(reading);
    const Topic<VotedAttitude> shared{topics::voted.spec.name, TypeId::voted_attitude, {}};  // without OWNERSHIP=EXCLUSIVE
    auto publisher = writer_bus->advertise(topics::voted, {.strength = 1, .lease_s = 0.05});
    auto subscription = reader_bus->subscribe(shared);

    ASSERT_TRUE(eventually(*reader_bus, [&] { return subscription.status().incompatible > 0; }));
    EXPECT_EQ(subscription.status().policy, "OWNERSHIP");
    EXPECT_EQ(subscription.status().matched, 0U);
}

/// Fast DDS repeats its endpoints to a node only after 1 s. A Cyclone DDS node that discovered it first must not have to wait for that.
TEST_P(VendorPairs, find_each_other_at_once_most_times_whoever_was_there_first)
{
    constexpr unsigned rounds = 20, required = 17;                   // a busy machine may be late now and then
    constexpr auto at_once_within = std::chrono::milliseconds{500};  // the fault costs 1 s, a sound start 25 to 170 ms
    const auto [first, second] = GetParam();
    const auto bus = open_on_loopback(first);
    auto publisher = bus->advertise(topics::verdict);
    auto subscription = bus->subscribe(topics::attitude);
    unsigned at_once = 0;
    for (unsigned round = 0; round < rounds; ++round) {
        ASSERT_TRUE(eventually(*bus, [&] { return publisher.status().matched == 0 && subscription.status().matched == 0; }));
        const auto other = open_on_loopback(second);
        auto attitudes = other->advertise(topics::attitude);
        auto verdicts = other->subscribe(topics::verdict);
        const auto start = Clock::now();
        ASSERT_TRUE(eventually(*bus, [&] { return publisher.status().matched > 0 && subscription.status().matched > 0; }));
        ASSERT_TRUE(eventually(*other, [&] { return attitudes.status().matched > 0 && verdicts.status().matched > 0; }));
        at_once += Clock::now() - start < at_once_within ? 1 : 0;
    }
    EXPECT_GE(at_once, required) << "of " << rounds;
}

}  // namespace

}  // namespace quorient::bus
