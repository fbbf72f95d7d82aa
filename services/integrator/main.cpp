#include "integrator_service.hpp"
#include "quorient/runtime/log.hpp"
#include "quorient/runtime/options.hpp"
#include "quorient/runtime/realtime.hpp"
#include "quorient/runtime/signals.hpp"

namespace {

int run(int argc, char** argv)
{
    using namespace quorient;
    const auto options = runtime::parse_options(argc, argv, "Integrates the trusted axes: one attitude per frame.", "");
    if (!options) return options.error().exit_code;

    const auto system =
        system::load(options->system_file, {.dds = options->dds, .domain = options->domain, .process = options->name, .set = options->set});
    if (!system) return runtime::report(system.error());

    const auto settings = system->integrator(options->name);
    if (!settings) return runtime::report(settings.error());

    const auto bus = bus::open(settings->process.bus);
    if (!bus) return runtime::report(bus.error());

    const runtime::SystemClock clock;
    runtime::EventLoop loop{**bus, clock, runtime::termination_requested()};
    loop.spin(settings->process.spin);
    integrator::IntegratorService service{*settings, **bus, loop};
    runtime::ask_for_realtime(settings->process.realtime);
    return runtime::ends_within(3, loop.run());
}

}  // namespace

int main(int argc, char** argv)
{
    return quorient::runtime::guarded(run, argc, argv);
}
