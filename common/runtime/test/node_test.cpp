// What every service does beside its work: events and their throttling, alarms of endpoints, readiness, status.

#include "quorient/bus/local_bus.hpp"
#include "quorient/bus/topics.hpp"
#include "quorient/messages/codes.hpp"
#include "quorient/messages/meaning.hpp"
#include "quorient/messages/name.hpp"
#include "quorient/messages/time.hpp"
#include "quorient/runtime/event_loop.hpp"
#include "quorient/runtime/node.hpp"

#include <gmock/gmock.h>
#include <atomic>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace quorient::runtime {

namespace {

using testing::HasSubstr;

VirtualClock clock_at_100_s()
{
    VirtualClock clock;
    clock.set(100 * quorient::second_ns);
    return clock;
}

class NodeTest : public testing::Test {
protected:
    static NodeSettings fdi_a()
    {
        NodeSettings settings;
        settings.name = "fdi-a";
        settings.unit = 3;
        settings.service = 17;
        settings.heartbeat = false;
        settings.log_events = false;
        return settings;
    }

    void pass(double time_s)
    {
        clock.set(clock.steady_ns() + nanoseconds(time_s));
        while (loop.dispatch()) continue;
    }

    /// What came since the last call.
    std::vector<HealthEvent> received(EventCode code)
    {
        std::vector<HealthEvent> found;
        HealthEvent event;
        while (events.take(event))
            if (code_of(event) == code) found.push_back(event);
        return found;
    }

    std::optional<ServiceStatus> newest_status()
    {
        std::optional<ServiceStatus> newest;
        ServiceStatus status;
        while (statuses.take(status)) newest = status;
        return newest;
    }

    bus::LocalHub hub;
    std::unique_ptr<bus::Bus> bus = hub.open(), outside = hub.open();
    bus::Subscription<HealthEvent> events = outside->subscribe(bus::topics::event);
    bus::Subscription<ServiceStatus> statuses = outside->subscribe(bus::topics::status);
    VirtualClock clock = clock_at_100_s();
    const std::atomic<bool> runs_on{false};
    EventLoop loop{*bus, clock, runs_on};
    std::optional<Node> node{std::in_place, fdi_a(), *bus, loop};
    bus::EndpointStatus endpoint;
};

TEST_F(NodeTest, says_in_an_event_who_reports_what_and_when)
{
    node->report(EventCode::isolated, Severity::warning_high, {.epoch = 7, .sequence = 1600}, 0b10, "ISOLATED G2", 5);
    node->report(EventCode::isolated, Severity::warning_high, {.epoch = 7, .sequence = 1601}, 0b10, "again");
    const auto got = received(EventCode::isolated);
    ASSERT_EQ(got.size(), 2U);
    EXPECT_EQ(text_of(got[0].source_name), "fdi-a");
    EXPECT_EQ(text_of(got[0].text), "ISOLATED G2");
    EXPECT_EQ(got[0].unit, 3U);
    EXPECT_EQ(got[0].source, 17U);
    EXPECT_EQ(got[0].sequence, 1600U);
    EXPECT_EQ(got[0].axes, 0b10U);
    EXPECT_EQ(got[0].request, 5U);
    EXPECT_EQ(got[0].wall_time_ns, 100 * quorient::second_ns);
    EXPECT_EQ(got[1].event_number, got[0].event_number + 1);
}

TEST_F(NodeTest, reports_a_repeated_event_once_a_second)
{
    int reported = 0;
    for (int i = 0; i < 35; ++i) {
        reported += node->report_throttled(EventCode::rejected_input, Severity::warning_low, {}, 0, "no number") ? 1 : 0;
        pass(0.1);
    }
    EXPECT_EQ(reported, 4) << "after 0, 1, 2 and 3 s";
    EXPECT_EQ(received(EventCode::rejected_input).size(), 4U);
}

TEST_F(NodeTest, throttles_no_event_for_the_sake_of_another)
{
    EXPECT_TRUE(node->report_throttled(EventCode::rejected_input, Severity::warning_low, {}, 0, "no number"));
    EXPECT_TRUE(node->report_throttled(EventCode::unknown_revision, Severity::warning_low, {}, 0, "no description"));
    EXPECT_FALSE(node->report_throttled(EventCode::unknown_revision, Severity::warning_low, {}, 0, "no description"));
    node->report(EventCode::unknown_revision, Severity::warning_low, {}, 0, "this one is not throttled");
    EXPECT_EQ(received(EventCode::unknown_revision).size(), 2U);
}

TEST_F(NodeTest, warns_once_of_an_endpoint_that_matched_nobody_for_5_s)
{
    node->watch("frame", [this] { return endpoint; }, true);
    for (int i = 0; i < 10; ++i) pass(0.5);
    EXPECT_TRUE(received(EventCode::no_match).empty()) << "5 s are not over";
    for (int i = 0; i < 20; ++i) pass(0.5);
    const auto warned = received(EventCode::no_match);
    ASSERT_EQ(warned.size(), 1U);
    EXPECT_THAT(text_of(warned[0].text), HasSubstr("frame matched nobody for 5 s"));
}

TEST_F(NodeTest, does_not_warn_of_an_endpoint_that_matched_in_time_or_need_not)
{
    bus::EndpointStatus lonely;
    node->watch("frame", [this] { return endpoint; }, true);
    node->watch("voted", [&] { return lonely; }, false);
    endpoint.matched = 1;
    pass(4);
    endpoint.matched = 0;  // its peer ends: that is another event's matter
    for (int i = 0; i < 20; ++i) pass(1);
    EXPECT_TRUE(received(EventCode::no_match).empty());
}

TEST_F(NodeTest, warns_of_every_further_incompatible_peer)
{
    node->watch("frame", [this] { return endpoint; }, false);
    pass(1);
    EXPECT_TRUE(received(EventCode::incompatible_qos).empty());
    endpoint.incompatible = 1;
    endpoint.policy = "RELIABILITY";
    pass(1);
    pass(1);
    const auto first = received(EventCode::incompatible_qos);
    ASSERT_EQ(first.size(), 1U);
    EXPECT_THAT(text_of(first[0].text), HasSubstr("RELIABILITY"));
    endpoint.incompatible = 2;
    pass(1);
    EXPECT_EQ(received(EventCode::incompatible_qos).size(), 1U);
}

TEST_F(NodeTest, warns_once_of_a_transport_that_is_not_the_one_asked_for)
{
    node->watch("frame", [this] { return endpoint; }, false);
    endpoint.asked = Transport::shared_memory;
    endpoint.transport = Transport::shared_memory;
    pass(1);
    EXPECT_TRUE(received(EventCode::transport_fallback).empty());
    endpoint.transport = Transport::udp;
    pass(1);
    pass(1);
    EXPECT_EQ(received(EventCode::transport_fallback).size(), 1U);
}

TEST_F(NodeTest, counts_samples_that_the_shared_memory_has_no_room_for)
{
    node->watch("frame", [this] { return endpoint; }, false);
    endpoint.refused = 4;
    pass(1);
    pass(1);
    endpoint.refused = 6;
    pass(1);
    const auto warned = received(EventCode::shared_memory_lost);
    ASSERT_EQ(warned.size(), 2U);
    EXPECT_THAT(text_of(warned[0].text), HasSubstr("4 samples not sent in all"));
    EXPECT_THAT(text_of(warned[1].text), HasSubstr("6 samples not sent in all"));
}

TEST_F(NodeTest, is_ready_when_it_has_all_it_needs_and_asks_no_more_then)
{
    bool has_all = false;
    int asked = 0;
    node->ready_when([&] {
        ++asked;
        return has_all;
    });
    for (int i = 0; i < 5; ++i) pass(0.02);
    EXPECT_EQ(node->state(), ServiceState::starting);
    EXPECT_EQ(asked, 5);
    has_all = true;
    pass(0.02);
    EXPECT_EQ(node->state(), ServiceState::ready);
    EXPECT_EQ(state_of(newest_status().value()), ServiceState::ready) << "published at once";
    for (int i = 0; i < 5; ++i) pass(0.02);
    EXPECT_EQ(asked, 6);
}

TEST_F(NodeTest, that_runs_already_does_not_become_ready_again)
{
    node->ready_when([] { return true; });
    node->set_state(ServiceState::running);
    pass(0.02);
    EXPECT_EQ(node->state(), ServiceState::running);
}

TEST_F(NodeTest, states_the_quantiles_of_the_times_since_arrival)
{
    constexpr std::int64_t ms_in_ns = 1'000'000;
    for (std::int64_t ms = 100; ms >= 1; --ms)
        node->handled({.epoch = 1, .sequence = static_cast<std::uint64_t>(101 - ms)}, clock.steady_ns() - ms * ms_in_ns);
    pass(0.5);
    const auto status = newest_status().value();
    EXPECT_EQ(status.received, 100U);
    EXPECT_EQ(status.sequence, 100U);
    const std::array<double, 4> expected_s{0.050, 0.090, 0.099, 0.100};
    for (std::size_t i = 0; i < expected_s.size(); ++i) EXPECT_NEAR(status.latency_s[i], expected_s[i], 1e-12) << i;
}

TEST_F(NodeTest, says_goodbye_at_its_end)
{
    node.reset();
    EXPECT_EQ(received(EventCode::goodbye).size(), 1U);
    EXPECT_EQ(state_of(newest_status().value()), ServiceState::stopping);
}

}  // namespace

}  // namespace quorient::runtime
