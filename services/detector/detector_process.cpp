#include "detector_process.hpp"

#include "detector_service.hpp"

namespace quorient::detector {

tl::expected<host::Process, std::string> find_process(const system::System& system, const std::string& name)
{
    const auto settings = system.detector(name);
    if (!settings) return tl::unexpected(settings.error());
    return host::process_of<DetectorService>(*settings);
}

tl::expected<host::Process, std::string> find_composed(const system::System& system, const std::string& name, const std::vector<std::string>& names)
{
    auto settings = system.detector(name);
    if (!settings) return tl::unexpected(settings.error());
    if (system.holds_lane(settings->detector, names)) settings->attitudes_from = bus::Reach::process;
    return host::process_of<DetectorService>(*settings);
}

}  // namespace quorient::detector
