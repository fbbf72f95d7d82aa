#include "quorient/runtime/event_loop.hpp"

#include "quorient/bus/local_bus.hpp"

#include <gtest/gtest.h>
#include <string>
#include <vector>

namespace quorient::runtime {

namespace {

class Loop : public testing::Test {
protected:
    Loop() : bus(hub.open()), loop(*bus, clock, stop) {}

    bus::LocalHub hub;
    std::unique_ptr<bus::Bus> bus;
    VirtualClock clock;
    std::atomic<bool> stop{false};
    EventLoop loop;
};

TEST_F(Loop, hands_samples_over_in_order)
{
    std::vector<std::uint64_t> seen;
    loop.on(bus->subscribe(bus::topics::frame), [&](const SensorFrame& frame) { seen.push_back(frame.sequence); });
    auto publisher = bus->advertise(bus::topics::frame);
    for (std::uint64_t i = 0; i < 3; ++i) {
        SensorFrame frame;
        frame.sequence = i;
        publisher.publish(frame);
    }
    EXPECT_TRUE(loop.dispatch());
    EXPECT_EQ(seen, (std::vector<std::uint64_t>{0, 1, 2}));
    EXPECT_FALSE(loop.dispatch());
}

TEST_F(Loop, fires_a_timer_once_and_not_before_its_time)
{
    int fired = 0;
    auto& timer = loop.timer([&] { ++fired; });
    timer.set(100);
    EXPECT_EQ(loop.next_deadline_ns(), 100);
    clock.set(99);
    loop.dispatch();
    EXPECT_EQ(fired, 0);
    clock.set(100);
    loop.dispatch();
    loop.dispatch();
    EXPECT_EQ(fired, 1);
}

TEST_F(Loop, does_not_fire_a_cancelled_timer)
{
    auto& timer = loop.timer([] { FAIL(); });
    timer.set(10);
    timer.cancel();
    clock.set(20);
    EXPECT_FALSE(loop.dispatch());
}

TEST_F(Loop, skips_what_a_repeating_timer_missed)
{
    int fired = 0;
    loop.every(10, [&] { ++fired; });
    clock.set(95);
    loop.dispatch();
    EXPECT_EQ(fired, 1);
    EXPECT_EQ(loop.next_deadline_ns(), 105);
}

TEST_F(Loop, repeats_a_timer_until_its_handler_is_content)
{
    int fired = 0;
    loop.until(10, [&] { return ++fired == 2; });
    for (const std::int64_t now : {10, 20, 30, 40}) {
        clock.set(now);
        loop.dispatch();
    }
    EXPECT_EQ(fired, 2);
}

TEST_F(Loop, lets_a_handler_set_its_own_timer_again)
{
    int fired = 0;
    Timer* timer = nullptr;
    timer = &loop.timer([&] {
        if (++fired < 3) timer->set(clock.steady_ns());
    });
    timer->set(0);
    while (loop.dispatch()) continue;
    EXPECT_EQ(fired, 3);
}

/// A bus without data, on which time passes as long as it is waited for.
class EmptyBus final : public bus::Bus {
public:
    explicit EmptyBus(VirtualClock& clock) : clock_(clock) {}

    void wait(std::int64_t timeout_ns) override
    {
        waits.push_back(timeout_ns);
        clock_.set(clock_.steady_ns() + timeout_ns);
    }
    Vendor vendor() const override { return Vendor::local; }

    std::vector<std::int64_t> waits;

private:
    std::unique_ptr<bus::Writer> make_writer(const bus::TopicSpec&, const bus::WriterOptions&) override { return nullptr; }
    std::unique_ptr<bus::Reader> make_reader(const bus::TopicSpec&, const bus::ReaderOptions&) override { return nullptr; }

    VirtualClock& clock_;
};

class Waits : public testing::Test {
protected:
    VirtualClock clock;
    EmptyBus bus{clock};
    std::atomic<bool> stop{false};
    EventLoop loop{bus, clock, stop};
};

TEST_F(Waits, last_until_the_next_timer)
{
    loop.timer([this] { loop.quit(0); }).set(100);
    loop.run();
    EXPECT_EQ(bus.waits, (std::vector<std::int64_t>{100}));
}

TEST_F(Waits, are_left_out_while_a_timer_is_due)
{
    int rounds = 0;
    Timer* again = nullptr;
    auto& timer = loop.timer([&] {
        if (++rounds == 3) loop.quit(0);
        else again->set(0);
    });
    again = &timer;
    timer.set(0);
    loop.run();
    EXPECT_EQ(rounds, 3);
    EXPECT_TRUE(bus.waits.empty());
}

TEST_F(Waits, are_left_out_where_the_loop_spins)
{
    loop.spin(true);
    loop.when_idle([this] {
        clock.set(clock.steady_ns() + 10);
        return false;
    });
    loop.timer([this] { loop.quit(0); }).set(100);
    loop.run();
    EXPECT_TRUE(bus.waits.empty());
}

TEST_F(Loop, ends_with_the_exit_code_it_was_told)
{
    loop.timer([&] { loop.quit(7); }).set(0);
    EXPECT_EQ(loop.run(), 7);
}

TEST_F(Loop, ends_when_asked_to_stop)
{
    stop = true;
    EXPECT_EQ(loop.run(), 0);
}

/// Keeps samples back until a round is over.
class KeepingBus final : public bus::Bus {
public:
    explicit KeepingBus(std::vector<std::string>& calls) : calls_(calls) {}

    void flush() override { calls_.emplace_back("flush"); }
    void wait(std::int64_t /*timeout_ns*/) override {}
    Vendor vendor() const override { return Vendor::local; }
    std::unique_ptr<bus::Writer> make_writer(const bus::TopicSpec& /*topic*/, const bus::WriterOptions& /*options*/) override { return nullptr; }
    std::unique_ptr<bus::Reader> make_reader(const bus::TopicSpec& /*topic*/, const bus::ReaderOptions& /*options*/) override { return nullptr; }

private:
    std::vector<std::string>& calls_;
};

TEST(Round, ends_with_what_the_bus_keeps_back_though_the_loop_does_not_wait)
{
    std::vector<std::string> calls;
    KeepingBus bus{calls};
    VirtualClock clock;
    std::atomic<bool> stop{false};
    EventLoop loop{bus, clock, stop};
    loop.timer([&] { calls.emplace_back("timer"); }).set(0);
    loop.after_round([&] { calls.emplace_back("after"); });
    loop.dispatch();
    EXPECT_EQ(calls, (std::vector<std::string>{"timer", "after", "flush"}));
}

}  // namespace

}  // namespace quorient::runtime
