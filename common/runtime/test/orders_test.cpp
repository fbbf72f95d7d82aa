// Orders: a service obeys those that its settings permit, and refuses the others with an event.

#include "quorient/bus/local_bus.hpp"
#include "quorient/bus/topics.hpp"
#include "quorient/messages/codes.hpp"
#include "quorient/messages/meaning.hpp"
#include "quorient/messages/name.hpp"
#include "quorient/runtime/event_loop.hpp"
#include "quorient/runtime/node.hpp"

#include <gmock/gmock.h>
#include <atomic>
#include <memory>
#include <string>
#include <vector>

namespace quorient::runtime {

namespace {

using testing::HasSubstr;

constexpr std::int64_t second_ns = 1'000'000'000;
constexpr std::int64_t day_ns = 86'400 * second_ns;

class OrdersTest : public testing::Test {
protected:
    void start(const NodeSettings& settings)
    {
        loop = std::make_unique<EventLoop>(*bus, clock, never_stop);
        node = std::make_unique<Node>(settings, *bus, *loop);
        node->on_order({CommandAction::inject, CommandAction::clear, CommandAction::readmit},
                       [this](const FaultCommand& order) { obeyed.push_back(action_of(order)); });
    }

    void send(CommandAction action, std::uint64_t request, std::uint32_t unit = 1)
    {
        FaultCommand order;
        order.unit = unit;
        order.action = octet(action);
        order.request = request;
        orders.publish(order);
        while (loop->dispatch()) continue;
    }

    std::vector<HealthEvent> reported(EventCode code)
    {
        std::vector<HealthEvent> found;
        HealthEvent event;
        while (events.take(event)) {
            if (event.code == octet(code)) found.push_back(event);
        }
        return found;
    }

    NodeSettings settings()
    {
        NodeSettings result;
        result.name = "fdi-a";
        result.unit = 1;
        result.heartbeat = false;
        result.log_events = false;
        return result;
    }

    bus::LocalHub hub;
    std::unique_ptr<bus::Bus> bus = hub.open(), outside = hub.open();
    bus::Publisher<FaultCommand> orders = outside->advertise(bus::topics::command);
    bus::Subscription<HealthEvent> events = outside->subscribe(bus::topics::event);
    VirtualClock clock;
    const std::atomic<bool> never_stop{false};
    std::unique_ptr<EventLoop> loop;
    std::unique_ptr<Node> node;
    std::vector<CommandAction> obeyed;
};

TEST_F(OrdersTest, are_obeyed_once_where_the_settings_permit_them)
{
    start(settings());
    send(CommandAction::inject, 1);
    send(CommandAction::inject, 1);  // repeated by its sender
    send(CommandAction::readmit, 2);
    EXPECT_EQ(obeyed, (std::vector{CommandAction::inject, CommandAction::readmit}));
    EXPECT_TRUE(reported(EventCode::command_refused).empty());
}

TEST_F(OrdersTest, are_refused_with_an_event_where_the_settings_do_not)
{
    auto strict = settings();
    strict.orders.inject = false;
    start(strict);
    send(CommandAction::inject, 1);
    send(CommandAction::clear, 2);
    send(CommandAction::readmit, 3);
    EXPECT_EQ(obeyed, std::vector{CommandAction::readmit});
    const auto refused = reported(EventCode::command_refused);
    ASSERT_EQ(refused.size(), 2U);
    EXPECT_EQ(refused.front().request, 1U);
    EXPECT_THAT(text_of(refused.front().text), HasSubstr("commands.inject"));
    EXPECT_THAT(text_of(refused.front().text), HasSubstr("unknown sender"));
}

TEST_F(OrdersTest, of_other_kinds_and_to_other_units_are_not_answered)
{
    auto strict = settings();
    strict.orders = {false, false, false};
    start(strict);
    send(CommandAction::reset_attitude, 1);
    send(CommandAction::inject, 2, 7);
    EXPECT_TRUE(obeyed.empty());
    EXPECT_TRUE(reported(EventCode::command_refused).empty());
}

TEST_F(OrdersTest, a_certificate_that_expires_within_30_days_is_reported_once_a_day)
{
    clock.set(100 * day_ns);
    auto expiring = settings();
    expiring.identity_expires_ns = clock.wall_ns() + 29 * day_ns;
    start(expiring);
    const auto after = [&](std::int64_t wait_ns) {
        clock.set(clock.steady_ns() + wait_ns);
        while (loop->dispatch()) continue;
        return reported(EventCode::identity_expires);
    };
    const auto first = after(second_ns);
    ASSERT_EQ(first.size(), 1U);
    EXPECT_THAT(text_of(first.front().text), HasSubstr("--renew fdi-a"));
    EXPECT_TRUE(after(second_ns).empty());
    EXPECT_EQ(after(day_ns).size(), 1U);
    const auto expired = after(40 * day_ns);
    ASSERT_EQ(expired.size(), 1U);
    EXPECT_THAT(text_of(expired.front().text), HasSubstr("has expired"));
}

TEST_F(OrdersTest, a_certificate_that_lasts_longer_is_not_reported)
{
    auto lasting = settings();
    lasting.identity_expires_ns = clock.wall_ns() + 31 * day_ns;
    start(lasting);
    clock.set(clock.steady_ns() + second_ns);
    while (loop->dispatch()) continue;
    EXPECT_TRUE(reported(EventCode::identity_expires).empty());
}

}  // namespace

}  // namespace quorient::runtime
