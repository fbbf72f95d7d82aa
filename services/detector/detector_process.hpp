#pragma once

#include "host/host.hpp"

namespace quorient::detector {

/// The detector process of this name in a system.
tl::expected<host::Process, std::string> find_process(const system::System& system, const std::string& name);

}  // namespace quorient::detector
