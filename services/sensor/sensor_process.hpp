#pragma once

#include "host/host.hpp"

namespace quorient::sensor {

/// The sensor process of a system. @returns what is wrong with its source.
tl::expected<host::Process, std::string> find_process(const system::System& system, const std::string& name);

}  // namespace quorient::sensor
