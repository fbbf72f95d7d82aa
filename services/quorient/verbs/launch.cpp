#include "../launch/processes.hpp"
#include "../launch/roudi.hpp"
#include "../launch/screen.hpp"
#include "cli/json_output.hpp"
#include "cli/output_file.hpp"
#include "cli/system_options.hpp"
#include "quorient/evaluation/run_observer.hpp"
#include "quorient/messages/time.hpp"
#include "quorient/runtime/event_loop.hpp"
#include "quorient/runtime/heartbeat.hpp"
#include "quorient/runtime/signals.hpp"
#include "report/run_picture.hpp"
#include "report/summary.hpp"
#include "verbs.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <unistd.h>
#include <algorithm>
#include <cerrno>
#include <chrono>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <memory>
#include <set>
#include <thread>

namespace quorient::cli {

namespace {


/// After the source has ended: the last frame's way through the pipeline, then the end of all processes.
constexpr std::int64_t linger_ns = second_ns;

struct LaunchOptions {
    SystemOptions system;
    std::optional<double> duration_s;
    std::vector<std::string> without;
    std::string plot;
    bool force = false;
    bool join = false;
    bool json = false;
};

/// A child to start: one process of the system file, or a composition of several.
struct Started {
    const char* service;
    std::vector<std::string> names;

    std::string name() const { return fmt::format("{}", fmt::join(names, "+")); }
    bool has(std::string_view wanted) const { return std::ranges::find(names, wanted) != names.end(); }
};

/// Children leave heartbeats and logs; /run/quorient belongs to root.
void prepare_run_directory()
{
    std::error_code refused;
    std::filesystem::create_directories(runtime::run_directory(), refused);
    if (::access(runtime::run_directory().c_str(), W_OK) != 0) {
        const auto own = std::filesystem::temp_directory_path() / fmt::format("quorient-{}", ::getuid());
        std::filesystem::create_directories(own);
        ::setenv("QUORIENT_RUN_DIR", own.c_str(), 1);
    }
}

/// The services stand beside this program.
std::string program(const char* name)
{
    return (std::filesystem::read_symlink("/proc/self/exe").parent_path() / name).string();
}

const char* service_of(ServiceRole role)
{
    switch (role) {
        case ServiceRole::sensor:
            return "quorient-sensor";
        case ServiceRole::detector:
            return "quorient-fdi";
        case ServiceRole::integrator:
            return "quorient-attitude";
        case ServiceRole::monitor:
            return "quorient-monitor";
        default:
            return "quorient-voter";
    }
}

/// The names that run together with one, as far as they are wanted; itself alone where the file does not compose it.
std::vector<std::string> together_with(const std::string& name, const system::System& system, const std::vector<std::string>& without)
{
    for (auto names : system.compositions) {
        if (std::ranges::find(names, name) == names.end()) continue;
        std::erase_if(names, [&](const std::string& one) { return std::ranges::find(without, one) != without.end(); });
        return names;
    }
    return {name};
}

/// What this launch starts. Explains a name that the system does not have on stderr, and ends the verb.
std::vector<Started> chosen_processes(const system::System& system, const std::vector<std::string>& without)
{
    for (const auto& name : without) {
        if (system.process(name)) continue;
        std::vector<std::string> known;
        for (const auto* process : system.processes()) known.push_back(process->node.name);
        fail(fmt::format("--without {}: the system has no such process; it has {}", name, fmt::join(known, ", ")));
    }
    std::vector<Started> chosen;
    for (const auto* process : system.processes()) {
        const auto& name = process->node.name;
        const bool left_out = std::ranges::find(without, name) != without.end();
        const bool has_company = std::ranges::any_of(chosen, [&](const Started& started) { return started.has(name); });
        if (left_out || has_company) continue;
        auto names = together_with(name, system, without);
        chosen.push_back({names.size() > 1 ? "quorient-run" : service_of(process->node.role), std::move(names)});
    }
    return chosen;
}

/// A process whose log cannot be written would print into this verb's own output.
std::string writable_log(const std::string& name)
{
    const auto file = (runtime::run_directory() / (name + ".log")).string();
    errno = 0;
    if (!std::ofstream(file, std::ios::app))
        fail(fmt::format("{}: cannot be written: {}; QUORIENT_RUN_DIR chooses another folder", file, std::strerror(errno)));
    return file;
}

void add_processes(const std::vector<Started>& chosen, const SystemOptions& options, launch::Processes& processes)
{
    for (const auto& started : chosen) {
        std::vector<std::string> command{program(started.service), options.file};
        if (started.names.size() == 1) command.push_back("--name");
        command.insert(command.end(), started.names.begin(), started.names.end());
        if (!options.dds.empty()) command.insert(command.end(), {"--dds", options.dds});
        if (options.domain) command.insert(command.end(), {"--domain", std::to_string(*options.domain)});
        for (const auto& assignment : options.assignments()) command.insert(command.end(), {"--set", assignment});
        processes.add(started.name(), started.names, std::move(command), writable_log(started.name()));
    }
}

/// Those of these processes that run already, as far as they show themselves while this waits: by a status, or by events of before.
std::set<std::string> already_running(const std::vector<Started>& chosen, std::uint32_t unit, bus::Bus& bus)
{
    constexpr auto discovery = std::chrono::milliseconds{500};
    auto events = bus.subscribe(bus::topics::event);
    auto statuses = bus.subscribe(bus::topics::status);
    std::set<std::string> running;
    const auto add = [&](std::uint32_t from_unit, std::string_view name) {
        if (from_unit == unit && std::ranges::any_of(chosen, [&](const Started& started) { return started.has(name); }))
            running.emplace(name);
    };
    HealthEvent event;
    ServiceStatus status;
    for (const auto deadline = std::chrono::steady_clock::now() + discovery; std::chrono::steady_clock::now() < deadline;
         bus.wait(second_ns / 50)) {
        while (events.take(event)) add(event.unit, text_of(event.source_name));
        while (statuses.take(status)) add(status.unit, text_of(status.name));
    }
    return running;
}

/// One run from start to summary.
class Run {
public:
    Run(const LaunchOptions& options, const std::vector<Started>& chosen, const system::System& system, bus::Bus& bus)
        : options_(options),
          system_(system),
          observer_(system),
          screen_(system, observer_, options.json),
          loop_(bus, clock_, runtime::termination_requested())
    {
        if (!options.plot.empty()) begin_picture(bus);
        loop_.on(bus.subscribe(bus::topics::cluster), [this](const ClusterDescription& m) { observer_.on_description(m); });
        loop_.on(bus.subscribe(bus::topics::truth), [this](const TruthState& m) { observer_.on_truth(m); });
        loop_.on(bus.subscribe(bus::topics::verdict), [this](const FaultVerdict& m) { observer_.on_verdict(m); });
        loop_.on(bus.subscribe(bus::topics::diagnosis), [this](const FaultDiagnosis& m) { observer_.on_diagnosis(m); });
        loop_.on(bus.subscribe(bus::topics::frame), [this](const SensorFrame& m) { observer_.on_frame(m); });
        loop_.on(bus.subscribe(bus::topics::attitude), [this](const AttitudeState& m) { observer_.on_attitude(m); });
        loop_.on(bus.subscribe(bus::topics::voter_output), [this](const VotedAttitude& m) { observer_.on_voted(m); });
        loop_.on(bus.subscribe(bus::topics::event), [this](const HealthEvent& m) { screen_.on_event(m, clock_.steady_ns()); });
        prepare_run_directory();
        roudi_problem_ = roudi_.start(system, processes_);
        add_processes(chosen, options.system, processes_);
    }

    int run()
    {
        if (!roudi_problem_.empty()) {
            fmt::print(stderr, "{}\n", roudi_problem_);
            return 1;
        }
        processes_.start();
        auto& end = loop_.timer([this] { loop_.quit(0); });
        loop_.every(second_ns / 20, [this, &end] {
            look_at_processes(end);
            screen_.print_due(clock_.steady_ns());
        });
        loop_.every(second_ns / 5, [this] { screen_.draw(processes_, clock_.wall_ns()); });
        if (options_.duration_s) end.set(clock_.steady_ns() + nanoseconds(*options_.duration_s));
        loop_.run();
        screen_.draw(processes_, clock_.wall_ns());
        screen_.print_rest();
        processes_.stop();
        return conclude();
    }

private:
    void begin_picture(bus::Bus& bus)
    {
        picture_.emplace(options_.plot, options_.force);
        timeline_.emplace(system_, observer_);
        loop_.on(bus.subscribe(bus::topics::truth), [this](const TruthState& m) { timeline_->on_truth(m); });
        loop_.on(bus.subscribe(bus::topics::verdict), [this](const FaultVerdict& m) { timeline_->on_verdict(m); });
        loop_.on(bus.subscribe(bus::topics::voter_output), [this](const VotedAttitude& m) { timeline_->on_voted(m); });
    }

    void look_at_processes(runtime::Timer& end)
    {
        if (roudi_.lost()) {
            fmt::print(stderr, "iceoryx's daemon is gone or another one: what starts from now on goes by UDP\n");
            processes_.add_arguments({"--set", "shared_memory=off"});
        }
        for (const auto& name : processes_.look(clock_.steady_ns())) {
            const auto& child = *processes_.find(name);
            if (child.daemon) continue;
            if (&child == processes_.find_member(system_.sensor.process.node.name) && child.exit_code == 0) {
                observer_.on_source_ended();
                end.set(clock_.steady_ns() + linger_ns);
            } else if (child.exit_code != 0) {
                report_death(child);
            }
        }
    }

    void report_death(const launch::Child& child)
    {
        constexpr int not_started = 127;
        if (child.exit_code == not_started)
            fmt::print(stderr, "{} cannot be started: {} is missing, or no program\n", child.name, child.command.front());
        else fmt::print(stderr, "{} ended with exit code {}{}; its log: {}\n", child.name, child.exit_code,
                   child.ended ? "" : ", starting it again", child.log_file);
        if (child.ended) {
            failed_ = true;
            loop_.quit(1);
        }
    }

    int conclude()
    {
        const auto failures = report::unmet(system_, observer_);
        if (options_.json) fmt::print("{}\n", dump(report::summary_json(system_, observer_)));
        else fmt::print("\n{}", report::summary_text(system_, observer_));
        for (const auto& failure : failures) fmt::print(stderr, "not as expected: {}\n", failure);
        if (!options_.json && system_.expectations.any() && failures.empty() && !failed_) fmt::print("as expected\n");
        if (picture_) {
            picture_->stream() << report::run_picture(system_, observer_, *timeline_);
            picture_->finish_document();
        }
        return failed_ || !failures.empty() ? 1 : 0;
    }

    const LaunchOptions& options_;
    const system::System& system_;
    runtime::SystemClock clock_;
    evaluation::RunObserver observer_;
    launch::Screen screen_;
    std::optional<OutputFile> picture_;
    std::optional<report::RunTimeline> timeline_;
    runtime::EventLoop loop_;
    launch::Processes processes_;
    launch::Roudi roudi_;
    std::string roudi_problem_;
    bool failed_ = false;
};

int launch_system(const LaunchOptions& options)
{
    const auto system = options.system.load();
    const auto bus = bus::open(system.monitor.bus);
    if (!bus) {
        fmt::print(stderr, "{}\n", bus.error());
        return 2;
    }
    const auto chosen = chosen_processes(system, options.without);
    if (!options.join) {
        const auto running = already_running(chosen, system.unit, **bus);
        if (!running.empty())
            fail(fmt::format("unit {} already runs on domain {}: {}; stop it, choose another --domain, or give --join", system.unit,
                             system.monitor.bus.domain, fmt::join(running, ", ")));
    }
    return Run{options, chosen, system, **bus}.run();
}

}  // namespace

void add_launch(Program& program)
{
    auto verb =
        program.verb("launch", "Start the processes of a system file, restart those that die, show what differs from normal, end with a summary");
    auto options = std::make_shared<LaunchOptions>();
    options->system.add_to(verb);
    verb.option("--duration", options->duration_s, "Stop after so many seconds; else when the source ends")
        .within(settings::above_zero)
        .value_name("S");
    verb.option("--without", options->without, "Do not start this process: it runs elsewhere, or a program of yours stands for it (repeatable)")
        .value_name("NAME");
    verb.option("--plot", options->plot, "Draw the run over time at its end: attitude error, residuals, axes left out, level").value_name("FILE.svg");
    add_force(verb, options->force);
    verb.flag("--join", options->join, "Start although processes of these names run on this domain already");
    verb.flag("--json", options->json, "The summary as JSON, nothing else on stdout");
    verb.footer(
        "Example:\n  quorient launch deploy/configurations/demo.yaml --dds fastdds");
    verb.not_as_asked_if("the file's `expect` is not met, no frame came, or a process could not be kept alive");
    verb.run([options] {
        if (const int exit_code = launch_system(*options); exit_code != 0) throw Exit{exit_code};
    });
}

}  // namespace quorient::cli
