#pragma once

#include "quorient/runtime/yaml.hpp"
#include "quorient/system/system.hpp"

namespace quorient::system {

/// The keys `dds`, `transport`, `interface`, `peers`, `domain` and the real-time ones, of the whole file or of one process.
void parse_process(runtime::Section& section, const Overrides& overrides, ProcessSettings& process);

/// Reports what the bus itself finds wrong, at the process's place in the file.
void check_bus(runtime::Section& section, const ProcessSettings& process);

}  // namespace quorient::system
