#include "event_order.hpp"

#include <algorithm>
#include <iterator>
#include <utility>

namespace quorient::launch {

void EventOrder::add(const HealthEvent& event, std::string time, std::int64_t now_ns)
{
    const auto wall_ns = [](const Held& held) { return held.event.wall_time_ns; };
    held_.insert(std::ranges::upper_bound(held_, event.wall_time_ns, {}, wall_ns), {event, std::move(time), now_ns});
}

std::vector<EventOrder::Held> EventOrder::due(std::int64_t now_ns)
{
    const auto latest = std::find_if(held_.rbegin(), held_.rend(), [&](const Held& held) { return now_ns - held.arrived_ns >= hold_back_ns; });
    return first(static_cast<std::size_t>(std::distance(latest, held_.rend())));
}

std::vector<EventOrder::Held> EventOrder::rest()
{
    return first(held_.size());
}

std::vector<EventOrder::Held> EventOrder::first(std::size_t count)
{
    const auto end = held_.begin() + static_cast<std::ptrdiff_t>(count);
    std::vector<Held> events(std::make_move_iterator(held_.begin()), std::make_move_iterator(end));
    held_.erase(held_.begin(), end);
    return events;
}

}  // namespace quorient::launch
