#include "screen.hpp"

#include "quorient/bus/settings.hpp"
#include "quorient/messages/meaning.hpp"
#include "quorient/messages/name.hpp"
#include "quorient/messages/words.hpp"
#include "quorient/system/numbers.hpp"
#include "report/standing.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <sys/ioctl.h>
#include <unistd.h>
#include <algorithm>

namespace quorient::launch {

namespace {

constexpr std::size_t most_events = 12;
constexpr std::size_t usual_width = 120;
constexpr double longest_silence_s = 1;

std::size_t terminal_width()
{
    winsize size{};
    return ::ioctl(STDOUT_FILENO, TIOCGWINSZ, &size) == 0 && size.ws_col > 0 ? size.ws_col : usual_width;
}

/// What is not normal in one lane; empty where all is.
std::string trouble_of(const system::System& system, const evaluation::RunObserver& run, std::size_t place)
{
    const auto& lane = run.lanes()[place];
    if (lane.verdicts == 0) return "has sent no verdict yet";
    const Identity newest = run.newest_truth();
    if (newest.epoch == lane.verdict.epoch && run.time_s(newest) - run.time_s(identity_of(lane.verdict)) > longest_silence_s)
        return fmt::format("SILENT since {:.1f} s", run.time_s(identity_of(lane.verdict)));
    const auto state = state_of(lane.verdict);
    if (state != VerdictState::healthy && state != VerdictState::isolated)
        return lane.verdict.suspect_mask != 0 ? fmt::format("{} {}", to_string(state), run.names_of(lane.verdict.suspect_mask))
                                              : std::string(to_string(state));
    const auto& voted = run.voted().latest;
    if (!run.voted().received || system.voters.empty())
        return lane.verdict.isolated_mask == 0 ? "" : fmt::format("isolated {}", run.names_of(lane.verdict.isolated_mask));
    if (exclusion_of(voted, place) != LaneExclusion::none) return fmt::format("not counted by the voter: {}", to_string(exclusion_of(voted, place)));
    if (lane.verdict.isolated_mask == voted.isolated_mask) return "";
    return fmt::format("isolated {}, the output {}", run.names_of(lane.verdict.isolated_mask), run.names_of(voted.isolated_mask));
}

std::string latest_error_text(const evaluation::RunObserver& run)
{
    const auto& errors = run.voted().errors;
    return errors.compared == 0
               ? std::string{}
               : fmt::format("error against the truth: {:.1e} rad now, {:.1e} at most", errors.final_rad, errors.largest_rad);
}

}  // namespace

std::vector<std::string> lane_lines(const system::System& system, const evaluation::RunObserver& run)
{
    std::vector<std::string> lines;
    std::vector<std::string> normal;
    for (std::size_t place = 0; place < run.lanes().size(); ++place) {
        const auto& lane = run.lanes()[place];
        const auto trouble = trouble_of(system, run, place);
        if (trouble.empty()) normal.push_back(lane.name);
        else lines.push_back(fmt::format("lane {} ({}): {}", lane.name, bus::to_string(lane.vendor), trouble));
    }
    if (!normal.empty()) lines.insert(lines.begin(), fmt::format("lane{} {}: normal", normal.size() > 1 ? "s" : "", fmt::join(normal, ", ")));
    return lines;
}

std::vector<std::string> process_lines(const Processes& processes)
{
    std::vector<std::string> lines;
    std::size_t running = 0;
    for (const auto& child : processes.all()) {
        const bool runs = child.process > 0;
        running += runs ? 1 : 0;
        if (child.restarts > 0)
            lines.push_back(fmt::format("{}: started again {} time{}", child.name, child.restarts, child.restarts == 1 ? "" : "s"));
        else if (!runs && !child.ended) lines.push_back(fmt::format("{}: does not run", child.name));
    }
    lines.insert(lines.begin(), fmt::format("{} of {} processes run", running, processes.all().size()));
    return lines;
}

Screen::Screen(const system::System& system, const evaluation::RunObserver& run, bool quiet)
    : system_(system), run_(run), quiet_(quiet), terminal_(::isatty(STDOUT_FILENO) == 1), story_(most_events)
{
}

std::string Screen::time_of(const HealthEvent& event) const
{
    return event.epoch == 0 ? std::string{} : fmt::format("{:.3f} s", run_.time_s({event.epoch, event.sequence}));
}

void Screen::on_event(const HealthEvent& event, std::int64_t steady_ns)
{
    if (quiet_ || event.unit != system_.unit) return;
    if (!terminal_) {
        order_.add(event, time_of(event), steady_ns);
        return;
    }
    story_.add(event, time_of(event));
    if (code_of(event) == EventCode::level_changed) {
        level_since_ns_ = event.wall_time_ns;
        level_voter_ = event.source;
    }
}

void Screen::print_due(std::int64_t steady_ns)
{
    print(order_.due(steady_ns));
}

void Screen::print_rest()
{
    print(order_.rest());
}

void Screen::print(const std::vector<EventOrder::Held>& events)
{
    for (const auto& [event, time, arrived_ns] : events)
        fmt::print("{:>9}  {:<11} {}\n", time, text_of(event.source_name), text_of(event.text));
    if (!events.empty()) std::fflush(stdout);
}

std::string Screen::standing(std::int64_t now_ns) const
{
    report::Standing standing;
    standing.description = run_.description();
    if (run_.voted().received) {
        standing.voted = run_.voted().latest;
        const auto owner = system_.unit * system::services_per_unit + system::first_voter_service + standing.voted->voter - 1;
        if (level_voter_ == owner) standing.level_since_ns = level_since_ns_;
    }
    for (const auto& lane : run_.lanes())
        if (lane.verdicts > 0) standing.verdicts[lane.verdict.detector] = lane.verdict;
    for (std::size_t place = 0; place < system_.lanes.size(); ++place) standing.lanes[system_.lanes[place].detector.lane] = system_.lanes[place].name;
    for (std::size_t place = 0; place < system_.voters.size(); ++place)
        standing.voters[static_cast<std::uint32_t>(place + 1)] = system_.voters[place].process.node.name;
    return report::standing_text(standing, now_ns);
}

std::vector<std::string> Screen::lines(const Processes& processes, std::int64_t now_ns) const
{
    std::vector<std::string> all{fmt::format("{}, {:.1f} s", system_.name, run_.time_s(run_.newest_truth())), standing(now_ns)};
    if (const auto error = latest_error_text(run_); !error.empty()) all.push_back(error);
    const auto add = [&](const std::vector<std::string>& more) { all.insert(all.end(), more.begin(), more.end()); };
    add(lane_lines(system_, run_));
    add(process_lines(processes));
    all.emplace_back();
    add(story_.lines());
    return all;
}

void Screen::draw(const Processes& processes, std::int64_t now_ns)
{
    if (quiet_ || !terminal_) return;
    std::string text;
    const auto all = lines(processes, now_ns);
    const auto width = terminal_width();
    for (const auto& line : all) text += line.substr(0, width) + "\n";
    if (drawn_lines_ > 0) fmt::print("\033[{}A\033[J", drawn_lines_);
    fmt::print("{}", text);
    std::fflush(stdout);
    drawn_lines_ = all.size();
}

}  // namespace quorient::launch
