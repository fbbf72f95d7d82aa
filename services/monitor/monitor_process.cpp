#include "monitor_process.hpp"

#include "monitor_service.hpp"
#include "site.hpp"

#include <fmt/format.h>
#include <sys/resource.h>
#include <memory>

namespace quorient::monitor {
namespace {

/// Whatever the pipeline needs comes first.
constexpr int niceness = 10;

/// The DDS side and the web side of one process; the web side ends first.
struct Monitoring final : host::Hosted {
    Monitoring(const system::System& system, bus::Bus& bus, runtime::EventLoop& loop)
        : service(system, exchange, bus, loop), site(system, exchange)
    {
    }
    Exchange exchange;
    MonitorService service;
    Site site;
};

tl::expected<host::Process, std::string> find_process(const system::System& system, const std::string& name)
{
    if (!system.web_monitor)
        return tl::unexpected(fmt::format("{}: there is no `monitor:` section; it says where the page is served", system.file));
    const auto& settings = *system.web_monitor;
    if (settings.process.node.name != name)
        return tl::unexpected(fmt::format("{}: no process '{}' of this kind; there is {}", system.file, name, settings.process.node.name));
    ::setpriority(PRIO_PROCESS, 0, niceness);  // the threads to come inherit it; lowering is never refused
    return host::Process{settings.process, [system](bus::Bus& bus, runtime::EventLoop& loop) {
                             return std::make_unique<Monitoring>(system, bus, loop);
                         }};
}

}  // namespace

host::Role role()
{
    return {"Shows a running system: a page, its state as JSON, and figures for Prometheus.",
            "monitor",
            find_process,
            {{"--allow-orders", "Accept orders from the page: inject faults, readmit axes, reset the attitude", "monitor.allow_orders=true"}}};
}

}  // namespace quorient::monitor
