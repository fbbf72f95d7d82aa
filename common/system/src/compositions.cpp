#include "build.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <algorithm>
#include <set>
#include <string>

namespace quorient::system {

namespace {

/// Settings that hold for a whole process, so that they must be the same for all that run in it.
const char* difference_of(const ProcessSettings& one, const ProcessSettings& other)
{
    if (one.bus.vendor != other.bus.vendor) return "dds";
    if (one.bus.domain != other.bus.domain) return "domain";
    if (one.bus.transport != other.bus.transport) return "transport";
    if (one.bus.shared_memory != other.bus.shared_memory) return "shared_memory";
    if (one.bus.interface != other.bus.interface) return "interface";
    if (one.bus.peers != other.bus.peers) return "peers";
    if (one.bus.participants_per_host != other.bus.participants_per_host) return "participants_per_host";
    if (one.realtime.priority != other.realtime.priority) return "priority";
    if (one.realtime.lock_memory != other.realtime.lock_memory) return "lock_memory";
    if (one.realtime.processors != other.realtime.processors) return "processors";
    if (one.spin != other.spin) return "spin";
    return nullptr;
}

std::string names_of(const System& system)
{
    std::vector<std::string> names;
    for (const auto* process : system.processes()) names.push_back(process->node.name);
    return fmt::format("{}", fmt::join(names, ", "));
}

/// What keeps a process from any composition; empty if nothing does.
std::string obstacle(const ProcessSettings& process)
{
    if (process.node.role == ServiceRole::monitor) return "the monitor runs alone: its priority is lower than that of the others";
    if (process.security.level != bus::SecurityLevel::none)
        return "a secured process runs alone: one participant has one certificate, which would have the permissions of all";
    return {};
}

}  // namespace

bool System::holds_lane(std::uint32_t detector, const std::vector<std::string>& names) const
{
    const auto named = [&](const ProcessSettings& process) { return std::ranges::find(names, process.node.name) != names.end(); };
    return std::ranges::any_of(lanes, [&](const LaneProcess& lane) {
        return lane.detector.detector == detector && named(lane.detector.process) && named(lane.integrator.process);
    });
}

std::optional<Discord> System::discord_of(const std::vector<std::string>& names) const
{
    std::set<std::string> known;
    for (std::size_t place = 0; place < names.size(); ++place) {
        const auto* one = process(names[place]);
        if (!one) return Discord{place, fmt::format("no process '{}'; there are {}", names[place], names_of(*this))};
        if (!known.insert(names[place]).second) return Discord{place, fmt::format("'{}' stands there twice", names[place])};
        if (auto why = obstacle(*one); !why.empty()) return Discord{place, std::move(why)};
        const auto* first = process(names.front());
        if (const auto* key = difference_of(*first, *one))
            return Discord{place, fmt::format("'{}' has another `{}` than '{}': one process has one", names[place], key, names.front())};
    }
    return std::nullopt;
}

void check_compositions(const System& system, Report& report)
{
    std::set<std::string> taken;
    for (std::size_t i = 0; i < system.compositions.size(); ++i) {
        const auto& names = system.compositions[i];
        if (names.size() < 2) report.at(fmt::format("compose[{}]", i), "a composition has two names at least");
        if (const auto discord = system.discord_of(names)) {
            report.at(fmt::format("compose[{}][{}]", i, discord->place), discord->why);
            continue;
        }
        for (std::size_t j = 0; j < names.size(); ++j)
            if (!taken.insert(names[j]).second)
                report.at(fmt::format("compose[{}][{}]", i, j), fmt::format("'{}' stands in another composition, too", names[j]));
    }
}

}  // namespace quorient::system
