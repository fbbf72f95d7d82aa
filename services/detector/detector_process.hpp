#pragma once

#include "host/host.hpp"

#include <string>
#include <tl/expected.hpp>
#include <vector>

namespace quorient::detector {

/// The detector process of this name in a system.
tl::expected<host::Process, std::string> find_process(const system::System& system, const std::string& name);

/// The same in one process with those of `names`. With its integrator among them it takes attitudes from nobody else.
tl::expected<host::Process, std::string> find_composed(const system::System& system, const std::string& name, const std::vector<std::string>& names);

}  // namespace quorient::detector
