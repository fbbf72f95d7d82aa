// The verbs that give orders: inject, readmit and reset.

#include "orders/named_axes.hpp"
#include "orders/order.hpp"
#include "quorient/bus/topics.hpp"
#include "quorient/geometry/sensor_cluster.hpp"
#include "quorient/messages/codes.hpp"
#include "quorient/messages/meaning.hpp"
#include "quorient/messages/time.hpp"
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
    std::vector<std::string> axes;
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
    const Order order(ours, *bus, loop, !options.bus.keys.empty());
    return loop.run();
}

/// What the unit's sensor publisher says of its axes. Ends the verb where it says nothing.
ClusterDescription description_of(const BusOptions& options)
{
    const auto bus = options.open("quorient-command");
    const runtime::SystemClock clock;
    runtime::EventLoop loop{*bus, clock, runtime::termination_requested()};
    ClusterDescription found;
    loop.on(bus->subscribe(bus::topics::cluster), [&](const ClusterDescription& description) {
        if (description.unit != options.unit) return;
        found = description;
        loop.quit(ExitCode::done);
    });
    loop.timer([&] { loop.quit(ExitCode::not_as_asked); }).set(clock.steady_ns() + nanoseconds(Order::patience_s));
    if (loop.run() == ExitCode::done && found.axis_count > 0) return found;
    fmt::print(stderr, "the names of the axes are not known: no description of unit {} came in domain {} on '{}' within {} s\n", options.unit,
               options.joined_domain(), options.interface, Order::patience_s);
    throw Exit{ExitCode::not_as_asked};
}

/// The axes by numbers alone, or by names, which the running unit knows.
AxisMask chosen_axes(const BusOptions& options, const std::vector<std::string>& words)
{
    const bool numbers = std::ranges::all_of(words, is_axis_number);
    const auto axes = named_axes(words, numbers ? ClusterDescription{} : description_of(options));
    if (!axes) fail(axes.error());
    return *axes;
}

/// axis= takes names too.
simulation::FaultSpec chosen_fault(const CommandOptions& options)
{
    auto fault = simulation::parse_fault(options.fault, [&](std::string_view text) { return chosen_axes(options.bus, axis_words(text)); });
    if (!fault) fail(fault.error());
    return std::move(*fault);
}

/// The axes of an instrument, which the running unit knows.
simulation::FaultSpec fault_of_instrument(const CommandOptions& options, const simulation::FaultSpec& fault)
{
    const auto cluster = geometry::make_cluster(description_of(options.bus));
    if (!cluster) fail(cluster.error());
    const auto resolved = simulation::resolve(fault, *cluster);
    if (!resolved) fail(resolved.error());
    return *resolved;
}

FaultCommand inject_command(const CommandOptions& options)
{
    FaultCommand command;
    if (options.clear) {
        command.action = octet(CommandAction::clear);
        return command;
    }
    if (options.fault.empty()) fail("nothing to do: give a fault, as in axis=1,kind=scale,value=0.8,start=0,end=10, or --clear");
    const auto fault = chosen_fault(options);
    return simulation::to_command(fault.instrument.empty() ? fault : fault_of_instrument(options, fault));
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
    const auto fault = verb.option("fault", options->fault, "axis=1,kind=scale,value=0.8,start=0,end=10; an axis's name will do, as in axis=G2");
    verb.flag("--clear", options->clear, "Take all faults back instead").in_place_of({fault});
    verb.footer(
        "Examples:\n  quorient inject axis=1,kind=bias,value=0.1,start=0\n  quorient inject 'axis=IMU3 y,kind=scale,value=0.8'\n  quorient inject instrument=IMU3,kind=zero");
    verb.not_as_asked_if("a service refused the order, or did not answer");
    verb.run([options] { finish(send(*options, inject_command(*options))); });
}

void add_readmit(Program& program)
{
    auto verb = program.verb("readmit", "Trust an isolated axis again");
    auto options = std::make_shared<CommandOptions>();
    options->bus.add_to(verb, "operator");
    verb.option("--axis", options->axes, "0-based number, or name: 1, G2, 'IMU3 y', IMU3 (all its axes); several as in 0,2 or repeated").required();
    verb.footer(
        "Refused while the other axes still contradict it, where a detector could not name it again (four axes; a vessel's channels).\n"
        "Example:\n  quorient readmit --axis G2");
    verb.not_as_asked_if("a service refused the order, or did not answer");
    verb.run([options] {
        FaultCommand command;
        command.action = octet(CommandAction::readmit);
        std::vector<std::string> words;
        for (const std::string& some : options->axes)
            for (std::string& word : axis_words(some)) words.push_back(std::move(word));
        command.axes = chosen_axes(options->bus, words);
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
