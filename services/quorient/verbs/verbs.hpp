#pragma once

#include <CLI/CLI.hpp>

namespace quorient::cli {

/// Each adds its sub-command with options, help and example to the program; the callback runs the verb.
/// A verb ends by returning, or by throwing CLI::RuntimeError(exit_code) after it has explained itself on stderr.
void add_layout(CLI::App& program);
void add_assess(CLI::App& program);
void add_propagate(CLI::App& program);
void add_simulate(CLI::App& program);
void add_vessel(CLI::App& program);

}  // namespace quorient::cli
