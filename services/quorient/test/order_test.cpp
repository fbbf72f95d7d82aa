// An order reaches each service that it concerns, also one that was not found, or not listening, when it was first sent.

#include "orders/order.hpp"

#include "quorient/bus/local_bus.hpp"
#include "quorient/bus/topics.hpp"
#include "quorient/messages/codes.hpp"
#include "quorient/messages/meaning.hpp"
#include "quorient/runtime/node.hpp"

#include <gtest/gtest.h>
#include <atomic>
#include <functional>
#include <list>
#include <memory>
#include <string>

namespace quorient::cli {

namespace {

constexpr std::int64_t millisecond_ns = 1'000'000;
constexpr std::uint64_t request = 7;

/// A detector's ear and voice.
class Detector {
public:
    Detector(bus::LocalHub& hub, const runtime::Clock& clock, std::uint32_t service, EventCode answer = EventCode::command_done)
        : bus_(hub.open()), loop_(*bus_, clock, never_stop_), node_(settings(service), *bus_, loop_)
    {
        loop_.on(bus_->subscribe(bus::topics::command), [this](const FaultCommand&) { ++words; });
        node_.on_order({CommandAction::readmit}, [this, answer](const FaultCommand& order) {
            ++obeyed;
            if (!mute) node_.report(answer, Severity::info, {}, order.axes, "readmits axis 1", order.request);
        });
        node_.set_state(ServiceState::running);
    }

    bool dispatch() { return loop_.dispatch(); }
    void stop() { node_.set_state(ServiceState::stopping); }

    bool mute = false;
    unsigned words = 0;
    unsigned obeyed = 0;

private:
    static runtime::NodeSettings settings(std::uint32_t service)
    {
        runtime::NodeSettings settings;
        settings.name = "fdi-" + std::to_string(service);
        settings.unit = 1;
        settings.service = service;
        settings.role = ServiceRole::detector;
        settings.heartbeat = false;
        settings.log_events = false;
        return settings;
    }

    std::atomic<bool> never_stop_{false};
    std::unique_ptr<bus::Bus> bus_;
    runtime::EventLoop loop_;
    runtime::Node node_;
};

class OrderTest : public testing::Test {
protected:
    OrderTest()
    {
        testing::internal::CaptureStdout();
        detectors.emplace_back(hub, clock, 1);
    }
    ~OrderTest() override { testing::internal::GetCapturedStdout(); }

    /// @param at  called with every 10 ms of time. @returns the exit code, or -1 if there is none within six seconds.
    int give(const std::function<void(int)>& at = [](int) {}, bool secured = false)
    {
        FaultCommand command;
        command.unit = 1;
        command.request = request;
        command.action = octet(CommandAction::readmit);
        const auto bus = hub.open();
        runtime::EventLoop loop(*bus, clock, never_stop);
        const Order order(command, *bus, loop, secured);
        for (int time_ms = 0; time_ms < 6000 && !loop.quit_requested(); time_ms += 10) {
            clock.set(clock.steady_ns() + 10 * millisecond_ns);
            at(time_ms);
            loop.dispatch();
            for (auto& detector : detectors) detector.dispatch();
        }
        return loop.quit_requested() ? loop.run() : -1;
    }

    bus::LocalHub hub;
    runtime::VirtualClock clock;
    std::atomic<bool> never_stop{false};
    std::list<Detector> detectors;
};

TEST_F(OrderTest, is_done_when_everybody_has_done_it)
{
    detectors.emplace_back(hub, clock, 2);
    EXPECT_EQ(give(), 0);
    for (const auto& detector : detectors) EXPECT_EQ(detector.obeyed, 1U);
    EXPECT_EQ(detectors.front().words, 1U) << "none was ordered twice";
}

TEST_F(OrderTest, is_repeated_for_who_came_after_its_first_word)
{
    const auto start_the_second = [this](int) {
        if (detectors.front().words == 1 && detectors.size() == 1) detectors.emplace_back(hub, clock, 2);
    };
    EXPECT_EQ(give(start_the_second), 0);
    ASSERT_EQ(detectors.size(), 2U);
    EXPECT_EQ(detectors.back().obeyed, 1U);
    EXPECT_EQ(detectors.front().obeyed, 1U) << "a detector that has received it does not do it again";
}

TEST_F(OrderTest, of_a_secured_system_looks_longer_for_whom_it_concerns)
{
    int first_word_ms = 0;
    const auto start_the_second = [&](int time_ms) {
        if (detectors.front().words == 0) first_word_ms = time_ms;
        if (time_ms == first_word_ms + 1500) detectors.emplace_back(hub, clock, 2);
    };
    EXPECT_EQ(give(start_the_second, true), 0);
    ASSERT_EQ(detectors.size(), 2U);
    EXPECT_EQ(detectors.back().obeyed, 1U);
}

TEST_F(OrderTest, names_who_does_not_answer)
{
    detectors.emplace_back(hub, clock, 2).mute = true;
    testing::internal::CaptureStderr();
    EXPECT_EQ(give(), 1);
    const auto text = testing::internal::GetCapturedStderr();
    EXPECT_NE(text.find("fdi-2"), std::string::npos) << text;
    EXPECT_EQ(text.find("fdi-1"), std::string::npos) << text;
}

TEST_F(OrderTest, fails_when_one_refuses)
{
    detectors.emplace_back(hub, clock, 2, EventCode::command_refused);
    EXPECT_EQ(give(), 1);
}

TEST_F(OrderTest, does_not_wait_for_who_says_goodbye)
{
    detectors.emplace_back(hub, clock, 2).mute = true;
    const auto stop_the_second = [this](int time_ms) {
        if (time_ms == 2000) detectors.back().stop();
    };
    EXPECT_EQ(give(stop_the_second), 0);
}

}  // namespace

}  // namespace quorient::cli
