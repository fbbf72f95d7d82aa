#include "broadcaster.hpp"

#include "quorient/runtime/clock.hpp"

#include <algorithm>

namespace quorient::monitor {

using Json = nlohmann::json;

namespace {

constexpr std::size_t most_events = 500;
constexpr std::int64_t longest_silence_ns = 2'000'000'000;

/// One message of a stream of server-sent events.
std::string message(const char* kind, const std::string& data)
{
    return std::string{"event: "} + kind + "\ndata: " + data + "\n\n";
}

}  // namespace

Broadcaster::Broadcaster(const Names& names, Exchange& exchange, ViewerServer& viewers)
    : names_(names),
      exchange_(exchange),
      viewers_(viewers),
      metrics_(names),
      events_(std::make_shared<const std::string>("[]")),
      thread_([this] { run(); })
{
}

Broadcaster::~Broadcaster()
{
    feed_.close();
    exchange_.close();
    thread_.join();
}

void Broadcaster::run()
{
    Tick tick;
    tick.events.reserve(max_events);
    while (!feed_.closed()) {
        if (exchange_.take(tick, std::chrono::milliseconds{200})) handle(tick);
    }
}

void Broadcaster::handle(const Tick& tick)
{
    const auto sample = sample_of(tick, names_.lanes.size());
    history_.add(sample);
    metrics_.update(tick);
    keep_events(tick);
    auto state = picture(tick, names_);
    auto text = std::make_shared<const std::string>(dumped(state));
    state["sample"] = sample_json(sample);
    std::string stream;
    if (!tick.events.empty()) {
        Json fresh = Json::array();
        for (const auto& event : tick.events) fresh.push_back(event_json(event));
        stream = message("events", dumped(fresh));
    }
    stream += message("state", dumped(state));
    {
        const std::lock_guard lock{mutex_};
        state_ = std::move(text);
    }
    feed_.publish(std::move(stream));
    viewers_.publish(tick);
    tick_ns_ = runtime::SystemClock{}.steady_ns();
}

void Broadcaster::keep_events(const Tick& tick)
{
    if (tick.events.empty()) return;
    for (const auto& event : tick.events) kept_.push_back(event_json(event));
    // A latched history arrives source by source.
    std::stable_sort(kept_.begin(), kept_.end(), [](const Json& a, const Json& b) { return a["wall_time_ms"] < b["wall_time_ms"]; });
    while (kept_.size() > most_events) kept_.pop_front();
    auto text = std::make_shared<const std::string>(dumped(Json(kept_)));
    const std::lock_guard lock{mutex_};
    events_ = std::move(text);
}

Text Broadcaster::state() const
{
    const std::lock_guard lock{mutex_};
    return state_;
}

Text Broadcaster::events() const
{
    const std::lock_guard lock{mutex_};
    return events_;
}

bool Broadcaster::alive() const
{
    const auto tick_ns = tick_ns_.load();
    return tick_ns != 0 && runtime::SystemClock{}.steady_ns() - tick_ns < longest_silence_ns;
}

}  // namespace quorient::monitor
