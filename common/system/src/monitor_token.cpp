#include "quorient/system/monitor_token.hpp"

#include <yaml-cpp/yaml.h>

namespace quorient::system {

std::string monitor_token_file(const System& system)
{
    if (!system.web_monitor) return {};
    return YAML::Load(system.configuration)["monitor"]["token_file"].as<std::string>(std::string{});
}

}  // namespace quorient::system
