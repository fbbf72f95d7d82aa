#include "quorient/runtime/log.hpp"
#include "quorient/runtime/options.hpp"
#include "quorient/runtime/realtime.hpp"
#include "quorient/runtime/signals.hpp"
#include "sensor_publisher.hpp"

namespace {

int run(int argc, char** argv)
{
    using namespace quorient;
    const auto options = runtime::parse_options(argc, argv, "Publishes a unit's gyro frames: simulated, or from a log.", "sensor");
    if (!options) return options.error().exit_code;

    const auto system =
        system::load(options->system_file, {.dds = options->dds, .domain = options->domain, .process = options->name, .set = options->set});
    if (!system) return runtime::report(system.error());

    const runtime::SystemClock clock;
    auto source = sensor::make_source(system->sensor, static_cast<std::uint64_t>(clock.wall_ns()));
    if (!source) return runtime::report(source.error());

    const auto bus = bus::open(system->sensor.process.bus);
    if (!bus) return runtime::report(bus.error());

    runtime::EventLoop loop{**bus, clock, runtime::termination_requested()};
    sensor::SensorPublisher service{system->sensor, std::move(*source), **bus, loop};
    runtime::ask_for_realtime(system->sensor.process.realtime);
    return runtime::ends_within(3, loop.run());
}

}  // namespace

int main(int argc, char** argv)
{
    return quorient::runtime::guarded(run, argc, argv);
}
