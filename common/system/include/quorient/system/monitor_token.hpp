#pragma once

#include "quorient/system/system.hpp"

#include <string>

namespace quorient::system {

/// The file of the token that lets other hosts send orders to the web monitor (security/token.hpp), as an absolute path.
/// Empty: this host alone sends orders. It is `monitor.token_file` of the configuration that holds.
std::string monitor_token_file(const System& system);

}  // namespace quorient::system
