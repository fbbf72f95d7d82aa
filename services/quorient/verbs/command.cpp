// The verbs that give orders: inject, readmit and reset.

#include "order.hpp"
#include "quorient/messages/codes.hpp"
#include "quorient/messages/meaning.hpp"
#include "quorient/runtime/signals.hpp"
#include "quorient/simulation/faults.hpp"
#include "cli/system_options.hpp"
#include "verbs.hpp"

#include <fmt/format.h>
#include <algorithm>
#include <memory>

namespace quorient::cli {

namespace {

struct CommandOptions {
    BusOptions bus;
    std::string fault;
    std::vector<std::size_t> axes;
    std::vector<double> attitude;
    bool clear = false;
};

int send(const CommandOptions& options, const FaultCommand& command)
{
    const auto bus = options.bus.open("quorient-command");
    const runtime::SystemClock clock;
    runtime::EventLoop loop{*bus, clock, runtime::termination_requested()};
    auto ours = command;
    ours.unit = options.bus.unit;
    ours.request = static_cast<std::uint64_t>(clock.wall_ns());
    const Order order(ours, *bus, loop);
    return loop.run();
}

FaultCommand inject_command(const CommandOptions& options)
{
    FaultCommand command;
    if (options.clear) {
        command.action = octet(CommandAction::clear);
        return command;
    }
    if (options.fault.empty()) fail("nothing to do: give a fault, as in axis=1,kind=scale,value=0.8,start=0,end=10, or --clear");
    const auto fault = simulation::parse_fault(options.fault);
    if (!fault || fault->axes == 0) {
        fmt::print(stderr, "{}\n", fault ? "a live fault names its axis: axis=1,…" : fault.error());
        throw Exit{2};
    }
    return simulation::to_command(*fault);
}

void finish(int exit_code)
{
    if (exit_code != 0) throw Exit{exit_code};
}

}  // namespace

void add_inject(Program& program)
{
    auto verb = program.verb("inject", "Break an axis of a running unit; times count from now");
    auto options = std::make_shared<CommandOptions>();
    options->bus.add_to(verb, "operator");
    const auto fault = verb.option("fault", options->fault, "axis=1,kind=scale,value=0.8,start=0,end=10");
    verb.flag("--clear", options->clear, "Take all faults back instead").in_place_of({fault});
    verb.footer("Example:\n  quorient inject axis=1,kind=bias,value=0.1,start=0");
    verb.not_as_asked_if("a service refused the order, or did not answer");
    verb.run([options] { finish(send(*options, inject_command(*options))); });
}

void add_readmit(Program& program)
{
    auto verb = program.verb("readmit", "Trust an isolated axis again");
    auto options = std::make_shared<CommandOptions>();
    options->bus.add_to(verb, "operator");
    verb.numbers("--axis", options->axes, 0, "0-based; repeatable").required().within({.lowest = 0, .highest = max_axes - 1});
    verb.footer(
        "Refused while the other axes still contradict it, where a detector could not name it again (four axes; a vessel's channels).\n"
        "Example:\n  quorient readmit --axis 1");
    verb.not_as_asked_if("a service refused the order, or did not answer");
    verb.run([options] {
        FaultCommand command;
        command.action = octet(CommandAction::readmit);
        for (const auto axis : options->axes) command.axes |= axis_bit(axis);
        finish(send(*options, command));
    });
}

void add_reset(Program& program)
{
    auto verb = program.verb("reset", "State the attitude anew, e.g. after LOST: all lanes take it at one frame");
    auto options = std::make_shared<CommandOptions>();
    options->bus.add_to(verb, "operator");
    verb.numbers("--attitude", options->attitude, 4, "w,x,y,z: body to reference at the newest frame").required();
    verb.footer("Example:\n  quorient reset --attitude 1,0,0,0");
    verb.not_as_asked_if("a service refused the order, or did not answer");
    verb.run([options] {
        FaultCommand command;
        command.action = octet(CommandAction::reset_attitude);
        std::copy_n(options->attitude.begin(), command.attitude.size(), command.attitude.begin());
        finish(send(*options, command));
    });
}

}  // namespace quorient::cli
