#include "collector.hpp"

#include "exchange.hpp"
#include "history.hpp"
#include "ticks.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <cmath>
#include <nlohmann/json.hpp>
#include <thread>

using namespace quorient;
using namespace quorient::monitor;
using monitor::test::demo;

namespace {

constexpr std::int64_t second_ns = 1'000'000'000;

}  // namespace

TEST(Collector, keeps_a_spike_of_one_sample_in_the_tick)
{
    Collector collector{demo()};
    for (std::uint64_t sequence = 0; sequence < 100; ++sequence) {
        auto verdict = test::verdict(sequence);
        verdict.residual[2] = sequence == 41 ? 5e-4 : 1e-8;
        collector.on_verdict(verdict, second_ns);
    }
    const auto& residual = collector.tick(second_ns, second_ns).lane[0].residual[2];
    EXPECT_EQ(residual.highest, 5e-4);
    EXPECT_EQ(residual.lowest, 1e-8);
    collector.begin();
    EXPECT_TRUE(collector.tick(second_ns, second_ns).lane[0].residual[2].empty()) << "the next tick begins anew";
}

TEST(Collector, a_tick_that_was_not_taken_goes_on_and_loses_nothing)
{
    Exchange exchange;
    Collector collector{demo()};
    ASSERT_TRUE(exchange.offer(collector.tick(second_ns, second_ns)));
    collector.begin();
    collector.on_event(test::event(1, "first"));
    ASSERT_FALSE(exchange.offer(collector.tick(second_ns, second_ns))) << "the web side has not taken the tick before";
    collector.defer();
    collector.on_event(test::event(2, "second"));
    Tick taken;
    ASSERT_TRUE(exchange.take(taken, std::chrono::milliseconds{0}));
    ASSERT_TRUE(exchange.offer(collector.tick(second_ns, second_ns)));
    ASSERT_TRUE(exchange.take(taken, std::chrono::milliseconds{0}));
    ASSERT_EQ(taken.events.size(), 2u);
    EXPECT_EQ(taken.ticks_deferred, 1u);
}

TEST(Collector, counts_events_that_no_tick_can_hold)
{
    Collector collector{demo()};
    for (std::uint64_t number = 1; number <= max_events + 3; ++number) collector.on_event(test::event(number, "much"));
    EXPECT_EQ(collector.tick(second_ns, second_ns).events.size(), max_events);
    EXPECT_EQ(collector.tick(second_ns, second_ns).events_lost, 3u);
}

TEST(Collector, compares_the_voted_attitude_with_the_truth_of_its_own_frame_whichever_comes_first)
{
    Collector collector{demo()};
    TruthState truth;
    truth.unit = 1;
    truth.epoch = 7;
    truth.attitude_known = 1;
    truth.attitude = {std::cos(5e-4), std::sin(5e-4), 0, 0};  // 1 mrad about x
    truth.sequence = 10;
    collector.on_truth(truth);
    collector.on_voted(test::voted(10), second_ns);
    EXPECT_NEAR(collector.tick(second_ns, second_ns).error_rad, 1e-3, 1e-12);
    collector.begin();
    collector.on_voted(test::voted(11), second_ns);
    EXPECT_TRUE(collector.tick(second_ns, second_ns).error.empty()) << "frame 11 has no truth yet";
    truth.sequence = 11;
    collector.on_truth(truth);
    EXPECT_NEAR(collector.tick(second_ns, second_ns).error.highest, 1e-3, 1e-12);
}

TEST(Collector, leaves_other_units_out)
{
    Collector collector{demo()};
    auto foreign = test::voted(1);
    foreign.unit = 2;
    collector.on_voted(foreign, second_ns);
    EXPECT_FALSE(collector.tick(second_ns, second_ns).voted_fresh);
    EXPECT_EQ(collector.tick(second_ns, second_ns).voted_frames, 0u);
}

TEST(Collector, what_is_older_than_a_second_is_not_fresh)
{
    Collector collector{demo()};
    collector.on_voted(test::voted(1), second_ns);
    collector.on_verdict(test::verdict(1), second_ns);
    EXPECT_TRUE(collector.tick(2 * second_ns, 0).voted_fresh);
    EXPECT_FALSE(collector.tick(2 * second_ns + 1, 0).voted_fresh);
    EXPECT_FALSE(collector.tick(2 * second_ns + 1, 0).lane[0].fresh);
}

TEST(Collector, a_service_with_another_process_was_restarted)
{
    Collector collector{demo()};
    ServiceStatus status;
    status.unit = 1;
    status.service = 110;
    status.process = 4711;
    collector.on_status(status, second_ns);
    status.wall_time_ns = second_ns / 2;
    status.published = 100;
    collector.on_status(status, second_ns);
    EXPECT_EQ(collector.tick(second_ns, 0).service[0].rate_hz, 200);
    EXPECT_EQ(collector.tick(second_ns, 0).service[0].restarts, 0u);
    status.process = 4712;
    status.published = 3;
    collector.on_status(status, second_ns);
    EXPECT_EQ(collector.tick(second_ns, 0).service[0].restarts, 1u);
    EXPECT_TRUE(std::isnan(collector.tick(second_ns, 0).service[0].rate_hz));
}

TEST(Exchange, the_dds_side_is_never_held_up_by_a_web_side_that_holds_the_lock)
{
    Exchange exchange;
    std::thread waiting{[&exchange] {
        Tick tick;
        while (exchange.take(tick, std::chrono::seconds{10})) continue;
    }};
    Tick tick;
    const auto begin = std::chrono::steady_clock::now();
    std::size_t taken = 0;
    for (int i = 0; i < 1000; ++i) taken += exchange.offer(tick) ? 1 : 0;
    EXPECT_LT(std::chrono::steady_clock::now() - begin, std::chrono::seconds{5});
    EXPECT_GT(taken, 0u);
    exchange.close();
    waiting.join();
}

TEST(Exchange, hands_orders_over_in_their_order_and_refuses_more_than_it_holds)
{
    Exchange exchange;
    FaultCommand command;
    for (std::uint64_t i = 1; i <= 8; ++i) {
        command.request = i;
        ASSERT_TRUE(exchange.order(command));
    }
    EXPECT_FALSE(exchange.order(command));
    EXPECT_EQ(exchange.next_order()->request, 1u);
    EXPECT_EQ(exchange.next_order()->request, 2u);
    EXPECT_TRUE(exchange.order(command));
}

TEST(History, keeps_ten_minutes_by_the_second_with_minimum_and_maximum)
{
    History history;
    Collector collector{demo()};
    collector.on_description(test::description());
    for (std::int64_t tenth = 0; tenth < 7000; ++tenth) {
        auto verdict = test::verdict(static_cast<std::uint64_t>(tenth));
        verdict.residual[1] = tenth == 6543 ? -3e-4 : 1e-8;
        collector.on_verdict(verdict, second_ns);
        history.add(sample_of(collector.tick(second_ns, (tenth + 1) * second_ns / 10), 3));
        collector.begin();
    }
    const auto seconds = nlohmann::json::parse(history.text());
    ASSERT_EQ(seconds.size(), History::longest_s);
    int spikes = 0;
    for (const auto& second : seconds) spikes += second["lanes"][0]["low"][1] == -3e-4 ? 1 : 0;
    EXPECT_EQ(spikes, 1);
}
