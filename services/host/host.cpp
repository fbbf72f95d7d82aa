#include "host.hpp"

#include "quorient/runtime/heartbeat_owner.hpp"
#include "quorient/runtime/log.hpp"
#include "quorient/runtime/realtime.hpp"
#include "quorient/runtime/signals.hpp"

#include <cassert>

namespace quorient::host {
namespace {

constexpr unsigned longest_leaving_s = 3;

int run_role(int argc, char** argv, const Role& role)
{
    const auto options = runtime::parse_options(argc, argv, role.purpose, role.default_name, role.switches);
    if (!options) return options.error().exit_code;

    const auto system =
        system::load(options->system_file, {.dds = options->dds, .domain = options->domain, .processes = {options->name}, .set = options->set});
    if (!system) return runtime::report(system.error());

    const auto process = role.find(*system, options->name);
    if (!process) return runtime::report(process.error());

    const auto bus = bus::open(process->settings.bus);
    if (!bus) return runtime::report(bus.error());

    return serve(**bus, system->name, {*process});
}

}  // namespace

int serve(bus::Bus& bus, const std::string& system, const std::vector<Process>& processes)
{
    assert(!processes.empty());
    const auto& settings = processes.front().settings;
    runtime::set_heartbeat_owner({system, settings.bus.domain, settings.node.unit});
    const runtime::SystemClock clock;
    runtime::EventLoop loop{bus, clock, runtime::termination_requested()};
    loop.spin(settings.spin);
    std::vector<std::unique_ptr<Hosted>> services;
    for (const auto& process : processes) services.push_back(process.start(bus, loop));
    runtime::ask_for_realtime(settings.realtime);
    const int exit_code = loop.run();
    runtime::leave_within(longest_leaving_s, exit_code);
    return exit_code;
}

int run(int argc, char** argv, const Role& role)
{
    return runtime::guarded([&role](int count, char** arguments) { return run_role(count, arguments, role); }, argc, argv);
}

}  // namespace quorient::host
