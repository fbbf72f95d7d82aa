#pragma once

#include "host/host.hpp"

namespace quorient::monitor {

/// The program's role: its process is the one that `monitor:` of the system file describes.
host::Role role();

}  // namespace quorient::monitor
