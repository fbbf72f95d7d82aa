// The verbs that give orders: inject, readmit and reset.

#include "message_json.hpp"
#include "quorient/bus/topics.hpp"
#include "quorient/runtime/event_loop.hpp"
#include "quorient/runtime/signals.hpp"
#include "quorient/runtime/words.hpp"
#include "quorient/simulation/faults.hpp"
#include "system_options.hpp"
#include "verbs.hpp"

#include <fmt/format.h>
#include <algorithm>
#include <memory>
#include <optional>

namespace quorient::cli {

namespace {

struct CommandOptions {
    BusOptions bus;
    std::string fault;
    std::vector<std::size_t> axes;
    std::vector<double> attitude;
    bool clear = false;
    double timeout_s = 5;
};

// All matches of a domain come within about a second of each other.
constexpr std::int64_t discovery_ns = 1'200'000'000;

// One service answers an injection; every lane a reset.
constexpr std::int64_t all_answers_ns = 300'000'000;

/// One order and what became of it.
class Order {
public:
    Order(const CommandOptions& options, const FaultCommand& command)
        : options_(options),
          command_(command),
          bus_(options.bus.open("quorient-command")),
          loop_(*bus_, clock_, runtime::termination_requested()),
          commands_(bus_->advertise(bus::topics::command)),
          begin_ns_(clock_.steady_ns())
    {
        command_.unit = options.bus.unit;
        command_.request = static_cast<std::uint64_t>(clock_.wall_ns());
        of_a_frame_ = command_.action == static_cast<std::uint8_t>(CommandAction::reset_attitude);
    }

    /// Sends once somebody listens, and waits for the answers. @returns the exit code.
    int run()
    {
        loop_.on(bus_->subscribe(bus::topics::frame), [this](const SensorFrame& frame) {
            if (frame.unit == command_.unit) newest_ = frame.sequence;
        });
        loop_.on(bus_->subscribe(bus::topics::event), [this](const HealthEvent& event) { on_event(event); });
        loop_.every(20'000'000, [this] { look(); });
        loop_
            .timer([this] {
                fmt::print(stderr, "no service of unit {} answered within {} s{}\n", command_.unit, options_.timeout_s,
                           of_a_frame_ && !newest_ ? ": there are no frames" : "");
                loop_.quit(1);
            })
            .set(begin_ns_ + static_cast<std::int64_t>(options_.timeout_s * 1e9));
        return loop_.run();
    }

private:
    void look()
    {
        const auto now_ns = clock_.steady_ns();
        const bool ready = commands_.status().matched > 0 && now_ns - begin_ns_ > discovery_ns && (newest_ || !of_a_frame_);
        if (sent_ns_ == 0 && ready) {
            if (of_a_frame_) command_.value = static_cast<double>(*newest_);
            commands_.publish(command_);
            sent_ns_ = now_ns;
        }
        if (answers_ > 0 && (!of_a_frame_ || now_ns - sent_ns_ > all_answers_ns)) loop_.quit(refused_ ? 1 : 0);
    }

    void on_event(const HealthEvent& event)
    {
        if (event.request != command_.request) return;
        fmt::print("{}: {}\n", runtime::text_of(event.source_name), runtime::text_of(event.text));
        refused_ = refused_ || event.code == static_cast<std::uint8_t>(EventCode::command_refused);
        ++answers_;
    }

    const CommandOptions& options_;
    FaultCommand command_;
    std::unique_ptr<bus::Bus> bus_;
    runtime::SystemClock clock_;
    runtime::EventLoop loop_;
    bus::Publisher<FaultCommand> commands_;
    std::int64_t begin_ns_;
    std::int64_t sent_ns_ = 0;
    bool of_a_frame_ = false;  ///< the order is about the newest frame
    std::optional<std::uint64_t> newest_;
    std::size_t answers_ = 0;
    bool refused_ = false;
};

int send(const CommandOptions& options, const FaultCommand& command)
{
    return Order(options, command).run();
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

void add_reset(CLI::App& program)
{
    auto* verb = program.add_subcommand("reset", "State the attitude anew, e.g. after LOST: all lanes take it at one frame");
    auto options = std::make_shared<CommandOptions>();
    options->bus.add_to(*verb);
    verb->add_option("--attitude", options->attitude, "w,x,y,z: body to reference at the newest frame")
        ->required()
        ->delimiter(',')
        ->expected(4);
    verb->footer("Example:\n  quorient reset --attitude 1,0,0,0");
    verb->callback([options] {
        FaultCommand command;
        command.action = static_cast<std::uint8_t>(CommandAction::reset_attitude);
        std::copy_n(options->attitude.begin(), command.attitude.size(), command.attitude.begin());
        finish(send(*options, command));
    });
}

}  // namespace quorient::cli
