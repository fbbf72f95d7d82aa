#include "composition.hpp"

#include "composition_options.hpp"
#include "detector_process.hpp"
#include "host/host.hpp"
#include "integrator_process.hpp"
#include "quorient/bus/composed_bus.hpp"
#include "quorient/runtime/log.hpp"
#include "sensor_process.hpp"
#include "voter_process.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <algorithm>

namespace quorient::composition {

namespace {

using Names = std::vector<std::string>;

/// In this order they start: a service before those that receive from it, so that one round of the event loop takes a frame through all.
/// The sensor comes last. It is ready when it is made, so the others must exist by then: the process is ready once all are.
constexpr std::array roles{ServiceRole::detector, ServiceRole::integrator, ServiceRole::voter, ServiceRole::sensor};

tl::expected<host::Process, std::string> find_process(const system::System& system, ServiceRole role, const std::string& name, const Names& names)
{
    switch (role) {
        case ServiceRole::sensor:
            return sensor::find_process(system, name);
        case ServiceRole::detector:
            return detector::find_composed(system, name, names);
        case ServiceRole::integrator:
            return integrator::find_composed(system, name, names);
        default:
            return voter::find_process(system, name);
    }
}

/// The names that are asked for, or the composition of the file that holds one of them.
tl::expected<Names, std::string> chosen(const Options& options, const system::System& system)
{
    if (options.of.empty()) return options.names;
    for (const auto& names : system.compositions)
        if (std::ranges::find(names, options.of) != names.end()) return names;
    return tl::unexpected(fmt::format("{}: no composition has a process '{}'; see `compose` in the file", system.file, options.of));
}

tl::expected<std::vector<host::Process>, std::string> find_processes(const system::System& system, const Names& names)
{
    if (const auto discord = system.discord_of(names))
        return tl::unexpected(fmt::format("{}: {}", names[discord->place], discord->why));
    std::vector<host::Process> processes;
    for (const auto role : roles) {
        for (const auto& name : names) {
            if (system.process(name)->node.role != role) continue;
            auto process = find_process(system, role, name, names);
            if (!process) return tl::unexpected(process.error());
            processes.push_back(std::move(*process));
        }
    }
    return processes;
}

}  // namespace

int run(int argc, char** argv)
{
    const auto options = parse_options(argc, argv);
    if (!options) return options.error().exit_code;

    const auto known = options->of.empty() ? options->names : Names{options->of};
    const auto system = system::load(options->system_file,
                                     {.dds = options->dds, .domain = options->domain, .processes = known, .set = options->set});
    if (!system) return runtime::report(system.error());

    const auto names = chosen(*options, *system);
    if (!names) return runtime::report(names.error());

    const auto processes = find_processes(*system, *names);
    if (!processes) return runtime::report(processes.error());

    auto settings = processes->front().settings.bus;
    settings.participant = fmt::format("{}", fmt::join(*names, "+"));
    const auto bus = bus::open_composed(settings);
    if (!bus) return runtime::report(bus.error());
    return host::serve(**bus, system->name, *processes);
}

}  // namespace quorient::composition
