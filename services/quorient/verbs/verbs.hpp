#pragma once

#include "cli/program.hpp"

namespace quorient::cli {

/// Each adds its sub-command with options, help and example to the program; the callback runs the verb.
/// A verb ends by returning, or by throwing Exit{exit_code} after it has explained itself on stderr.
void add_launch(Program& program);
void add_echo(Program& program);
void add_status(Program& program);
void add_inject(Program& program);
void add_readmit(Program& program);
void add_reset(Program& program);
void add_health(Program& program);
void add_record(Program& program);
void add_replay(Program& program);
void add_clean(Program& program);
void add_check(Program& program);
void add_keys(Program& program);
void add_layout(Program& program);
void add_design(Program& program);
void add_assess(Program& program);
void add_propagate(Program& program);
void add_simulate(Program& program);
void add_vessel(Program& program);
void add_calibrate(Program& program);
void add_diagnose(Program& program);

/// All verbs of the program.
void add_verbs(Program& program);

/// The program with all its verbs. @returns its exit code
int run_quorient(int argc, char** argv);

}  // namespace quorient::cli
