#include "detector_process.hpp"

#include "detector_service.hpp"

namespace quorient::detector {

tl::expected<host::Process, std::string> find_process(const system::System& system, const std::string& name)
{
    const auto settings = system.detector(name);
    if (!settings) return tl::unexpected(settings.error());
    return host::process_of<DetectorService>(*settings);
}

}  // namespace quorient::detector
