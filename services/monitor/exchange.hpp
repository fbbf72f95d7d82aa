#pragma once

#include "quorient/messages/fault_command.hpp"
#include "tick.hpp"

#include <algorithm>
#include <array>
#include <chrono>
#include <condition_variable>
#include <mutex>
#include <optional>
#include <utility>

namespace quorient::monitor {

/// Between the DDS thread and the web's threads: one tick in one direction, a few orders in the other.
/// The DDS thread only tries the lock. If it is held, or the tick before was not taken, the thread goes on and tries again later.
class Exchange {
public:
    Exchange() { tick_.events.reserve(max_events); }

    /// DDS thread. @returns false where the tick was not taken over; nothing is lost as long as the caller keeps it.
    bool offer(const Tick& tick)
    {
        const std::unique_lock lock{mutex_, std::try_to_lock};
        if (!lock || full_) return false;
        tick_ = tick;
        full_ = true;
        offered_.notify_one();
        return true;
    }

    /// Web side: waits for the next tick. @returns false where none came in time, or after close().
    bool take(Tick& tick, std::chrono::milliseconds patience)
    {
        std::unique_lock lock{mutex_};
        offered_.wait_for(lock, patience, [this] { return full_ || closed_; });
        if (!full_ || closed_) return false;
        std::swap(tick, tick_);
        full_ = false;
        return true;
    }

    /// Web side. @returns false where too many orders wait already.
    bool order(const FaultCommand& command)
    {
        const std::lock_guard lock{mutex_};
        if (order_count_ == orders_.size()) return false;
        orders_[order_count_++] = command;
        return true;
    }

    /// DDS thread: the oldest order that waits, if the lock is free.
    std::optional<FaultCommand> next_order()
    {
        const std::unique_lock lock{mutex_, std::try_to_lock};
        if (!lock || order_count_ == 0) return std::nullopt;
        const FaultCommand oldest = orders_.front();
        std::move(orders_.begin() + 1, orders_.end(), orders_.begin());
        --order_count_;
        return oldest;
    }

    void close()
    {
        const std::lock_guard lock{mutex_};
        closed_ = true;
        offered_.notify_all();
    }

private:
    std::mutex mutex_;
    std::condition_variable offered_;
    Tick tick_;
    bool full_ = false;
    bool closed_ = false;
    std::array<FaultCommand, 8> orders_{};
    std::size_t order_count_ = 0;
};

}  // namespace quorient::monitor
