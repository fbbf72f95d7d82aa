#pragma once

#include "quorient/bus/bus.hpp"
#include "quorient/runtime/clock.hpp"

#include <atomic>
#include <cstdint>
#include <functional>
#include <limits>
#include <list>
#include <memory>
#include <utility>

namespace quorient::runtime {

/// Fires once at its deadline, then rests until it is set again.
class Timer {
public:
    explicit Timer(std::function<void()> handler) : handler_(std::move(handler)) {}

    void set(std::int64_t deadline_ns) { deadline_ns_ = deadline_ns; }
    void cancel() { deadline_ns_ = off; }
    bool is_set() const { return deadline_ns_ != off; }

private:
    friend class EventLoop;
    static constexpr std::int64_t off = std::numeric_limits<std::int64_t>::max();

    std::function<void()> handler_;
    std::int64_t deadline_ns_ = off;
};

/// One thread around one bus: waits for data and timers, calls handlers. Nothing is allocated after everything is registered.
class EventLoop {
public:
    /// @param stop  ends run() within 50 ms when it turns true.
    EventLoop(bus::Bus& bus, const Clock& clock, const std::atomic<bool>& stop) : bus_(bus), clock_(clock), stop_(stop) {}

    /// Hands every sample to `handler`, oldest first. @returns the subscription, which lives as long as the loop.
    template <class Message, class Handler>
    bus::Subscription<Message>& on(bus::Subscription<Message> subscription, Handler handler);

    /// A timer that lives as long as the loop.
    Timer& timer(std::function<void()> handler) { return timers_.emplace_back(std::move(handler)); }

    /// A timer that sets itself again. The first call comes after one period.
    void every(std::int64_t period_ns, std::function<void()> handler);

    /// As every(), until the handler returns true.
    void until(std::int64_t period_ns, std::function<bool()> handler);

    /// Called when all that is there has been handled, for as long as it returns true; must be short.
    void when_idle(std::function<bool()> work) { idle_.push_back(std::move(work)); }

    /// Called when all inputs have been read once and what is due has been done.
    void after_round(std::function<void()> handler) { after_round_.push_back(std::move(handler)); }

    /// Spins instead of blocking: a core for a little latency.
    void spin(bool on) { spin_ = on; }

    /// Until stop or quit(). @returns the exit code.
    int run();

    /// Ends run() after the handler that calls it.
    void quit(int exit_code);

    bool quit_requested() const { return quit_; }

    /// Handles all that is there and due, without waiting. @returns whether anything was.
    bool dispatch();

    /// One round of what is left for idle time. @returns whether more is left.
    bool work();

    /// When the next timer is due; int64 max if none is set.
    std::int64_t next_deadline_ns() const;

    const Clock& clock() const { return clock_; }

private:
    struct Input {
        virtual ~Input() = default;
        virtual bool poll() = 0;
    };
    template <class Message, class Handler>
    struct TypedInput;

    void wait();
    bool fire_timers();

    bus::Bus& bus_;
    const Clock& clock_;
    const std::atomic<bool>& stop_;
    std::list<std::unique_ptr<Input>> inputs_;
    std::list<Timer> timers_;
    std::list<std::function<bool()>> idle_;
    std::list<std::function<void()>> after_round_;
    bool spin_ = false;
    bool quit_ = false;
    int exit_code_ = 0;
};

template <class Message, class Handler>
struct EventLoop::TypedInput final : EventLoop::Input {
    TypedInput(bus::Subscription<Message> s, Handler h) : subscription(std::move(s)), handler(std::move(h)) {}

    bool poll() override
    {
        bool any = false;
        while (subscription.take(message)) {
            handler(std::as_const(message));
            any = true;
        }
        return any;
    }

    bus::Subscription<Message> subscription;
    Handler handler;
    Message message;
};

template <class Message, class Handler>
bus::Subscription<Message>& EventLoop::on(bus::Subscription<Message> subscription, Handler handler)
{
    auto input = std::make_unique<TypedInput<Message, Handler>>(std::move(subscription), std::move(handler));
    auto& stored = input->subscription;
    inputs_.push_back(std::move(input));
    return stored;
}

}  // namespace quorient::runtime
