#include "story.hpp"

#include "quorient/messages/meaning.hpp"
#include "quorient/messages/name.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <algorithm>
#include <string_view>

namespace quorient::launch {

namespace {

/// Events of one cause reach the bus within this time; flapping is one line as long as its pauses are shorter.
constexpr std::int64_t together_ns = 2'000'000'000;

/// Good news about the end of a trouble, or an order that was carried out. Other events of no consequence are left out.
bool is_worth_a_line(const HealthEvent& event)
{
    if (severity_of(event) != Severity::info) return true;
    switch (code_of(event)) {
        case EventCode::readmitted:
        case EventCode::returned:
        case EventCode::rolled_back:
        case EventCode::seeded:
        case EventCode::present:
        case EventCode::primary_changed:
        case EventCode::lane_returned:
        case EventCode::level_changed:
        case EventCode::ownership_taken:
        case EventCode::fault_injected:
        case EventCode::fault_cleared:
        case EventCode::command_done:
        case EventCode::command_refused:
            return true;
        default:
            return false;
    }
}

/// The names without what they all begin with; nothing where one begins otherwise.
std::vector<std::string> without(const std::vector<std::string>& names, std::string_view beginning)
{
    std::vector<std::string> rest;
    for (const auto& name : names) {
        if (!name.starts_with(beginning)) return {};
        rest.push_back(name.substr(beginning.size()));
    }
    std::ranges::sort(rest);
    return rest;
}

}  // namespace

std::string names_together(const std::vector<std::string>& processes)
{
    const auto group = [&](std::string_view beginning, const char* what) {
        const auto rest = without(processes, beginning);
        return rest.empty() ? std::string{} : fmt::format("{}{} {}", what, rest.size() > 1 ? "s" : "", fmt::join(rest, ", "));
    };
    if (auto detectors = group("fdi-", "detector"); !detectors.empty()) return detectors;
    if (auto integrators = group("attitude-", "integrator"); !integrators.empty()) return integrators;
    return fmt::format("{}", fmt::join(processes, ", "));
}

void Story::add(const HealthEvent& event, const std::string& time)
{
    if (!is_worth_a_line(event)) return;
    const std::string source{text_of(event.source_name)};
    const std::string text{text_of(event.text)};
    const auto same = std::ranges::find_if(entries_, [&](const Entry& entry) {
        return entry.code == code_of(event) && entry.axes == event.axes && event.wall_time_ns - entry.last_ns < together_ns &&
               entry.first_ns - event.wall_time_ns < together_ns;
    });
    if (same != entries_.end()) {
        ++same->events;
        if (event.wall_time_ns >= same->last_ns) same->text = text;
        same->last_ns = std::max(same->last_ns, event.wall_time_ns);
        if (std::ranges::find(same->sources, source) == same->sources.end()) same->sources.push_back(source);
        return;
    }
    const auto place = std::ranges::upper_bound(entries_, event.wall_time_ns, {}, &Entry::first_ns);
    entries_.insert(place, {code_of(event), event.axes, event.wall_time_ns, event.wall_time_ns, time, {source}, 1, text});
    if (entries_.size() > most_lines_) entries_.pop_front();
}

std::vector<std::string> Story::lines() const
{
    std::vector<std::string> lines;
    for (const Entry& entry : entries_) {
        const bool repeated = static_cast<std::size_t>(entry.events) > entry.sources.size();
        lines.push_back(fmt::format("{:>11}  {:<22} {}{}", entry.time, names_together(entry.sources), entry.text,
                                    repeated ? fmt::format(" (x{})", entry.events) : ""));
    }
    return lines;
}

}  // namespace quorient::launch
