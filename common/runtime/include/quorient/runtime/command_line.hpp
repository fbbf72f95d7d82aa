#pragma once

#include "quorient/runtime/options.hpp"

#include <tl/expected.hpp>

namespace CLI {
class App;
}

namespace quorient::runtime {

/// --version, and the system file as first argument.
void add_system_file(CLI::App& app, SystemChoice& choice);

/// --dds, --domain and --set.
void add_overrides(CLI::App& app, SystemChoice& choice);

/// Reads a command line. What it lacks, and --help, is explained. The choices' options must still be where they were added.
tl::expected<void, OptionsError> parse(CLI::App& app, int argc, char** argv);

}  // namespace quorient::runtime
