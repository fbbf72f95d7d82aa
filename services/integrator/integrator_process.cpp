#include "integrator_process.hpp"

#include "integrator_service.hpp"

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
    if (system.holds_lane(settings->detector, names)) settings->verdicts_from = bus::Reach::process;
    return host::process_of<IntegratorService>(*settings);
}

}  // namespace quorient::integrator
