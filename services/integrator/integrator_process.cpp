#include "integrator_process.hpp"

#include "integrator_service.hpp"

namespace quorient::integrator {

tl::expected<host::Process, std::string> find_process(const system::System& system, const std::string& name)
{
    const auto settings = system.integrator(name);
    if (!settings) return tl::unexpected(settings.error());
    return host::process_of<IntegratorService>(*settings);
}

}  // namespace quorient::integrator
