#include "quorient/runtime/event_loop.hpp"

#include <algorithm>

namespace quorient::runtime {

namespace {

/// A signal does not wake the wait set; this bounds how late it is noticed.
constexpr std::int64_t longest_wait_ns = 50'000'000;

}  // namespace

void EventLoop::every(std::int64_t period_ns, std::function<void()> handler)
{
    auto& repeating = timers_.emplace_back([] {});
    repeating.handler_ = [this, &repeating, period_ns, handler = std::move(handler)] {
        // Late calls are skipped, not made up for.
        const auto now = clock_.steady_ns();
        repeating.set(now + period_ns);
        handler();
    };
    repeating.set(clock_.steady_ns() + period_ns);
}

void EventLoop::until(std::int64_t period_ns, std::function<bool()> handler)
{
    auto& repeating = timers_.emplace_back([] {});
    repeating.handler_ = [this, &repeating, period_ns, handler = std::move(handler)] {
        if (!handler()) repeating.set(clock_.steady_ns() + period_ns);
    };
    repeating.set(clock_.steady_ns() + period_ns);
}

int EventLoop::run()
{
    while (!quit_ && !stop_.load(std::memory_order_relaxed)) {
        // What comes while it is handled ends the wait at once: no second look at every input, which would cost each sample as much again.
        dispatch();
        if (!work() && !quit_) wait();
    }
    return exit_code_;
}

void EventLoop::quit(int exit_code)
{
    quit_ = true;
    exit_code_ = exit_code;
}

bool EventLoop::dispatch()
{
    bool any = false;
    for (auto& input : inputs_) any = input->poll() || any;
    any = fire_timers() || any;
    for (auto& handler : after_round_) handler();
    bus_.flush();
    return any;
}

std::int64_t EventLoop::next_deadline_ns() const
{
    auto next = Timer::off;
    for (const auto& timer : timers_) next = std::min(next, timer.deadline_ns_);
    return next;
}

void EventLoop::wait()
{
    const auto until_timer = next_deadline_ns() - clock_.steady_ns();
    // A wait of no time at all is a sleep, too: of the kernel's timer slack, 50 us.
    if (spin_ || until_timer <= 0) return;
    bus_.wait(std::min(until_timer, longest_wait_ns));
}

bool EventLoop::fire_timers()
{
    bool any = false;
    const auto now = clock_.steady_ns();
    for (auto& timer : timers_) {
        if (timer.deadline_ns_ > now) continue;
        timer.cancel();
        timer.handler_();
        any = true;
    }
    return any;
}

bool EventLoop::work()
{
    bool more = false;
    for (auto& work : idle_) more = work() || more;
    return more;
}

}  // namespace quorient::runtime
