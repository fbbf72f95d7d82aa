#include "host.hpp"

#include "quorient/runtime/log.hpp"
#include "quorient/runtime/realtime.hpp"
#include "quorient/runtime/signals.hpp"

namespace quorient::host {
namespace {

constexpr unsigned longest_leaving_s = 3;

int run_role(int argc, char** argv, const Role& role)
{
    const auto options = runtime::parse_options(argc, argv, role.purpose, role.default_name, role.switches);
    if (!options) return options.error().exit_code;

    const auto system =
        system::load(options->system_file, {.dds = options->dds, .domain = options->domain, .process = options->name, .set = options->set});
    if (!system) return runtime::report(system.error());

    const auto process = role.find(*system, options->name);
    if (!process) return runtime::report(process.error());

    const auto bus = bus::open(process->settings.bus);
    if (!bus) return runtime::report(bus.error());

    const runtime::SystemClock clock;
    runtime::EventLoop loop{**bus, clock, runtime::termination_requested()};
    loop.spin(process->settings.spin);
    const auto service = process->start(**bus, loop);
    runtime::ask_for_realtime(process->settings.realtime);
    const int exit_code = loop.run();
    runtime::leave_within(longest_leaving_s, exit_code);
    return exit_code;
}

}  // namespace

int run(int argc, char** argv, const Role& role)
{
    return runtime::guarded([&role](int count, char** arguments) { return run_role(count, arguments, role); }, argc, argv);
}

}  // namespace quorient::host
