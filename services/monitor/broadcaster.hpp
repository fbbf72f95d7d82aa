#pragma once

#include "exchange.hpp"
#include "feed.hpp"
#include "history.hpp"
#include "metrics.hpp"
#include "picture.hpp"
#include "viewer_server.hpp"

#include <atomic>
#include <cstdint>
#include <deque>
#include <mutex>
#include <string>
#include <thread>

namespace quorient::monitor {

/// The thread between the DDS thread and the web's: turns each tick into text once, for all streams.
class Broadcaster {
public:
    Broadcaster(const Names& names, Exchange& exchange, ViewerServer& viewers);
    ~Broadcaster();
    Broadcaster(const Broadcaster&) = delete;
    Broadcaster& operator=(const Broadcaster&) = delete;

    Feed& feed() { return feed_; }
    const History& history() const { return history_; }
    Metrics& metrics() { return metrics_; }

    /// The newest state as JSON; nothing before the first tick.
    Text state() const;

    /// The newest events as a JSON array, oldest first.
    Text events() const;

    /// Whether the DDS side hands over ticks.
    bool alive() const;

private:
    void run();
    void handle(const Tick& tick);
    void keep_events(const Tick& tick);

    const Names& names_;
    Exchange& exchange_;
    ViewerServer& viewers_;
    Feed feed_;
    History history_;
    Metrics metrics_;
    std::deque<nlohmann::json> kept_;
    mutable std::mutex mutex_;
    Text state_;
    Text events_;
    std::atomic<std::int64_t> tick_ns_{0};  // steady
    std::thread thread_;
};

}  // namespace quorient::monitor
