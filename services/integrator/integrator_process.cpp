#include "integrator_process.hpp"

#include "integrator_service.hpp"

#include <algorithm>

namespace quorient::integrator {

tl::expected<host::Process, std::string> find_process(const system::System& system, const std::string& name)
{
    const auto settings = system.integrator(name);
    if (!settings) return tl::unexpected(settings.error());
    return host::process_of<IntegratorService>(*settings);
}

tl::expected<host::Process, std::string> find_composed(const system::System& system, const std::string& name, const std::vector<std::string>& names)
{
    auto settings = system.integrator(name);
    if (!settings) return tl::unexpected(settings.error());
    const bool detector_beside = std::ranges::any_of(system.lanes, [&](const system::LaneProcess& lane) {
        return lane.detector.detector == settings->detector && std::ranges::find(names, lane.detector.process.node.name) != names.end();
    });
    if (detector_beside) settings->verdicts_from = bus::Reach::process;
    return host::process_of<IntegratorService>(*settings);
}

}  // namespace quorient::integrator
