#pragma once

#include <CLI/CLI.hpp>

namespace quorient::cli {

/// Each adds its sub-command with options, help and example to the program; the callback runs the verb.
/// A verb ends by returning, or by throwing CLI::RuntimeError(exit_code) after it has explained itself on stderr.
void add_launch(CLI::App& program);
void add_echo(CLI::App& program);
void add_status(CLI::App& program);
void add_inject(CLI::App& program);
void add_readmit(CLI::App& program);
void add_reset(CLI::App& program);
void add_health(CLI::App& program);
void add_record(CLI::App& program);
void add_replay(CLI::App& program);
void add_clean(CLI::App& program);
void add_layout(CLI::App& program);
void add_assess(CLI::App& program);
void add_propagate(CLI::App& program);
void add_simulate(CLI::App& program);
void add_vessel(CLI::App& program);
void add_calibrate(CLI::App& program);
void add_lab(CLI::App& program);

/// All verbs of the program.
void add_verbs(CLI::App& program);

}  // namespace quorient::cli
