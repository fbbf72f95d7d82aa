#include "launch/event_order.hpp"

#include <gtest/gtest.h>
#include <algorithm>
#include <random>
#include <vector>

namespace quorient::launch {
namespace {

constexpr std::int64_t ms_ns = 1'000'000;

HealthEvent at(std::int64_t wall_ms)
{
    HealthEvent event;
    event.wall_time_ns = wall_ms * ms_ns;
    return event;
}

std::vector<std::int64_t> times_ms(const std::vector<EventOrder::Held>& events)
{
    std::vector<std::int64_t> times;
    for (const auto& held : events) times.push_back(held.event.wall_time_ns / ms_ns);
    return times;
}

using Times = std::vector<std::int64_t>;

TEST(EventOrder, gives_the_events_of_several_processes_in_the_order_of_time)
{
    EventOrder order;
    order.add(at(30), "", 0);
    order.add(at(10), "", 50 * ms_ns);
    order.add(at(20), "", 100 * ms_ns);
    EXPECT_EQ(times_ms(order.due(199 * ms_ns)), Times{}) << "an earlier one may still arrive";
    EXPECT_EQ(times_ms(order.due(200 * ms_ns)), (Times{10, 20, 30}));
    EXPECT_EQ(times_ms(order.rest()), Times{});
}

TEST(EventOrder, holds_back_what_may_have_a_predecessor)
{
    EventOrder order;
    order.add(at(10), "", 0);
    order.add(at(30), "", 150 * ms_ns);
    EXPECT_EQ(times_ms(order.due(200 * ms_ns)), Times{10});
    order.add(at(20), "", 210 * ms_ns);
    EXPECT_EQ(times_ms(order.due(350 * ms_ns)), (Times{20, 30}));
}

TEST(EventOrder, gives_at_the_end_what_is_left)
{
    EventOrder order;
    order.add(at(20), "", 0);
    order.add(at(10), "", 0);
    EXPECT_EQ(times_ms(order.rest()), (Times{10, 20}));
    EXPECT_EQ(times_ms(order.due(1000 * ms_ns)), Times{});
}

TEST(EventOrder, keeps_the_order_of_arrival_where_times_are_equal)
{
    EventOrder order;
    order.add(at(10), "first", 0);
    order.add(at(10), "second", 1);
    const auto given = order.rest();
    ASSERT_EQ(given.size(), 2U);
    EXPECT_EQ(given[0].time, "first");
    EXPECT_EQ(given[1].time, "second");
}

TEST(EventOrder, holds_for_whatever_arrives_up_to_200_ms_late)
{
    constexpr unsigned seed = 11;
    std::mt19937 random(seed);
    std::uniform_int_distribution<std::int64_t> late_ms(0, 199);
    struct Arrival {
        std::int64_t wall_ms;
        std::int64_t arrives_ms;
    };
    std::vector<Arrival> arrivals;
    for (std::int64_t wall_ms = 0; wall_ms < 20'000; wall_ms += 7) arrivals.push_back({wall_ms, wall_ms + late_ms(random)});
    std::ranges::stable_sort(arrivals, {}, &Arrival::arrives_ms);
    EventOrder order;
    Times given;
    auto next = arrivals.begin();
    for (std::int64_t now_ms = 0; now_ms < 21'000; ++now_ms) {
        for (; next != arrivals.end() && next->arrives_ms <= now_ms; ++next) order.add(at(next->wall_ms), "", now_ms * ms_ns);
        if (now_ms % 50 == 0) std::ranges::copy(times_ms(order.due(now_ms * ms_ns)), std::back_inserter(given));
    }
    EXPECT_EQ(given.size(), arrivals.size());
    EXPECT_TRUE(std::ranges::is_sorted(given)) << "seed " << seed;
}

}  // namespace
}  // namespace quorient::launch
