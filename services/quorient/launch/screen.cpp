#include "screen.hpp"

#include "quorient/bus/settings.hpp"
#include "quorient/messages/meaning.hpp"
#include "quorient/messages/name.hpp"
#include "quorient/messages/words.hpp"

#include <fmt/format.h>
#include <unistd.h>

namespace quorient::launch {

namespace {

constexpr std::size_t events_shown = 6;

}  // namespace

Screen::Screen(const system::System& system, const evaluation::RunObserver& run, bool quiet)
    : system_(system), run_(run), quiet_(quiet), terminal_(::isatty(STDOUT_FILENO) == 1)
{
}

std::string Screen::line_of(const HealthEvent& event) const
{
    const Identity identity{event.epoch, event.sequence};
    const auto time = event.epoch == 0 ? std::string{"         "} : fmt::format("{:7.3f} s", run_.time_s(identity));
    return fmt::format("{}  {:<11} {}", time, text_of(event.source_name), text_of(event.text));
}

void Screen::on_event(const HealthEvent& event)
{
    if (quiet_ || event.unit != system_.unit) return;
    const auto line = line_of(event);
    if (!terminal_) {
        fmt::print("{}\n", line);
        std::fflush(stdout);
        return;
    }
    latest_.push_back(line);
    if (latest_.size() > events_shown) latest_.pop_front();
}

void Screen::draw(const Processes& processes)
{
    if (quiet_ || !terminal_) return;
    std::string text = fmt::format("{:.2f} s  {}\n{:<6}{:<12}{:<13}{:<18}{:<14}{}\n", run_.time_s(run_.newest_truth()), system_.name,
                                   "lane", "vendor", "state", "isolated", "error [rad]", "restarts");
    for (const auto& lane : run_.lanes()) {
        const auto* detector = processes.find_member("fdi-" + lane.name);
        const auto* integrator = processes.find_member("attitude-" + lane.name);
        const int restarts = (detector ? detector->restarts : 0) + (integrator && integrator != detector ? integrator->restarts : 0);
        text += fmt::format("{:<6}{:<12}{:<13}{:<18}{:<14}{}\n", lane.name, bus::to_string(lane.vendor), to_string(state_of(lane.verdict)),
                            lane.verdict.isolated_mask ? run_.names_of(lane.verdict.isolated_mask) : "-",
                            lane.errors.compared ? fmt::format("{:.2e}", lane.errors.final_rad) : "-", restarts);
    }
    const auto& voted = run_.voted();
    if (!system_.integrators().empty())
        text += fmt::format("{:<6}{:<12}{:<13}{:<18}{:<14}\n", "voted", "", to_string(level_of(voted.latest)), "",
                            voted.errors.compared ? fmt::format("{:.2e}", voted.errors.final_rad) : "-");
    int lines = (system_.integrators().empty() ? 2 : 3) + static_cast<int>(run_.lanes().size());
    for (const auto& line : latest_) {
        text += line.substr(0, 120) + "\n";
        ++lines;
    }
    if (drawn_lines_ > 0) fmt::print("\033[{}A\033[J", drawn_lines_);
    fmt::print("{}", text);
    std::fflush(stdout);
    drawn_lines_ = lines;
}

}  // namespace quorient::launch
