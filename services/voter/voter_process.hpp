#pragma once

#include "host/host.hpp"

namespace quorient::voter {

/// The voter process of this name in a system.
tl::expected<host::Process, std::string> find_process(const system::System& system, const std::string& name);

}  // namespace quorient::voter
