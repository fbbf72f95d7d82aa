#pragma once

#include "quorient/bus/bus.hpp"
#include "quorient/runtime/event_loop.hpp"
#include "quorient/runtime/options.hpp"
#include "quorient/system/system.hpp"

#include <functional>
#include <memory>
#include <string>
#include <string_view>
#include <tl/expected.hpp>
#include <utility>
#include <vector>

namespace quorient::host {

/// A service that lives on an event loop until it is destroyed.
class Hosted {
public:
    virtual ~Hosted() = default;
};

/// One process of a system file: what it needs, and how its service starts once bus and loop are there.
struct Process {
    system::ProcessSettings settings;
    std::function<std::unique_ptr<Hosted>(bus::Bus&, runtime::EventLoop&)> start;
};

/// Finds the process of a name in a system. @returns what is wrong with it, or which names this role has.
using FindProcess = std::function<tl::expected<Process, std::string>(const system::System&, const std::string& name)>;

/// The process of a service that is constructed from its settings, the bus and the loop.
template <class Service, class Settings>
Process process_of(const Settings& settings)
{
    struct Holder final : Hosted {
        Holder(const Settings& its, bus::Bus& bus, runtime::EventLoop& loop) : service(its, bus, loop) {}
        Service service;
    };
    return {settings.process,
            [settings](bus::Bus& bus, runtime::EventLoop& loop) { return std::make_unique<Holder>(settings, bus, loop); }};
}

/// What the program of one role says of itself.
struct Role {
    std::string purpose;       ///< one sentence, for --help
    std::string default_name;  ///< its process's in the system file; empty = --name is required
    FindProcess find;
    std::vector<runtime::Switch> switches{};  ///< flags of this role alone
};

/// Runs the services of these processes on one event loop until they end or are to stop. Their bus and real-time settings are the
/// same. @param system  name of their system, for their heartbeats. @returns the exit code
int serve(bus::Bus& bus, const std::string& system, const std::vector<Process>& processes);

/// main() of a service: reads the command line and the system file, joins the bus, runs until a signal ends it.
/// @returns the exit code: 0 ended in order, 1 failed while running, 2 bad usage or configuration (explained on stderr).
int run(int argc, char** argv, const Role& role);

}  // namespace quorient::host
