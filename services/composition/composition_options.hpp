#pragma once

#include "quorient/runtime/options.hpp"

#include <string>
#include <tl/expected.hpp>
#include <vector>

namespace quorient::composition {

/// The command line of `quorient-run`.
struct Options : runtime::SystemChoice {
    std::vector<std::string> names;  ///< processes of the system file
    std::string of;                  ///< in their place: the composition of the file that this process is in
};

/// Reads SYSTEM.yaml NAME… [--dds VENDOR] [--domain N] [--set KEY=VALUE …], or --of NAME in place of the names.
tl::expected<Options, runtime::OptionsError> parse_options(int argc, char** argv);

}  // namespace quorient::composition
