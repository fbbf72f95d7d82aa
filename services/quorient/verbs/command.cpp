// The verbs that give orders: inject and readmit.

#include "message_json.hpp"
#include "quorient/bus/topics.hpp"
#include "quorient/runtime/event_loop.hpp"
#include "quorient/runtime/signals.hpp"
#include "quorient/runtime/words.hpp"
#include "quorient/simulation/faults.hpp"
#include "system_options.hpp"
#include "verbs.hpp"

#include <fmt/format.h>
#include <memory>

namespace quorient::cli {

namespace {

struct CommandOptions {
    BusOptions bus;
    std::string fault;
    std::vector<std::size_t> axes;
    bool clear = false;
    double timeout_s = 5;
};

/// Sends once somebody listens, and waits for the answer of one service.
int send(const CommandOptions& options, FaultCommand command)
{
    const auto bus = options.bus.open("quorient-command");
    const runtime::SystemClock clock;
    runtime::EventLoop loop{*bus, clock, runtime::termination_requested()};
    command.unit = options.bus.unit;
    command.request = static_cast<std::uint64_t>(clock.wall_ns());
    auto commands = bus->advertise(bus::topics::command);
    loop.on(bus->subscribe(bus::topics::event), [&](const HealthEvent& event) {
        if (event.request != command.request) return;
        fmt::print("{}: {}\n", runtime::text_of(event.source_name), runtime::text_of(event.text));
        loop.quit(event.code == static_cast<std::uint8_t>(EventCode::command_refused) ? 1 : 0);
    });
    bool sent = false;
    const auto begin = clock.steady_ns();
    loop.every(20'000'000, [&] {
        // All matches of a domain come within about a second of each other.
        const auto waited_ns = clock.steady_ns() - begin;
        if (sent || commands.status().matched == 0 || waited_ns < 1'200'000'000) return;
        commands.publish(command);
        sent = true;
    });
    loop.timer([&] {
            fmt::print(stderr, "no service of unit {} answered within {} s\n", options.bus.unit, options.timeout_s);
            loop.quit(1);
        })
        .set(begin + static_cast<std::int64_t>(options.timeout_s * 1e9));
    return loop.run();
}

FaultCommand inject_command(const CommandOptions& options)
{
    FaultCommand command;
    if (options.clear) {
        command.action = static_cast<std::uint8_t>(CommandAction::clear);
        return command;
    }
    const auto fault = simulation::parse_fault(options.fault);
    if (!fault || fault->axes == 0) {
        fmt::print(stderr, "{}\n", fault ? "a live fault names its axis: axis=1,…" : fault.error());
        throw CLI::RuntimeError(2);
    }
    return simulation::to_command(*fault);
}

void finish(int exit_code)
{
    if (exit_code != 0) throw CLI::RuntimeError(exit_code);
}

}  // namespace

void add_inject(CLI::App& program)
{
    auto* verb = program.add_subcommand("inject", "Break an axis of a running unit; times count from now");
    auto options = std::make_shared<CommandOptions>();
    options->bus.add_to(*verb);
    verb->add_option("fault", options->fault, "axis=1,kind=scale,value=0.8,start=0,end=10");
    verb->add_flag("--clear", options->clear, "Take all faults back instead");
    verb->footer("Example:\n  quorient inject axis=1,kind=bias,value=0.1,start=0");
    verb->callback([options] { finish(send(*options, inject_command(*options))); });
}

void add_readmit(CLI::App& program)
{
    auto* verb = program.add_subcommand("readmit", "Trust an isolated axis again");
    auto options = std::make_shared<CommandOptions>();
    options->bus.add_to(*verb);
    verb->add_option("--axis", options->axes, "0-based; repeatable")->required()->check(CLI::Range(0, static_cast<int>(max_axes) - 1));
    verb->footer("Example:\n  quorient readmit --axis 1");
    verb->callback([options] {
        FaultCommand command;
        command.action = static_cast<std::uint8_t>(CommandAction::readmit);
        for (const auto axis : options->axes) command.axes |= axis_bit(axis);
        finish(send(*options, command));
    });
}

}  // namespace quorient::cli
