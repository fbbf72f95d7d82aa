#include "voter_process.hpp"

#include "voter_service.hpp"

namespace quorient::voter {

tl::expected<host::Process, std::string> find_process(const system::System& system, const std::string& name)
{
    const auto settings = system.voter(name);
    if (!settings) return tl::unexpected(settings.error());
    return host::process_of<VoterService>(*settings);
}

}  // namespace quorient::voter
