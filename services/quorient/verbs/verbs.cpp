#include "verbs.hpp"

namespace quorient::cli {

void add_verbs(Program& program)
{
    add_launch(program);
    add_echo(program);
    add_status(program);
    add_inject(program);
    add_readmit(program);
    add_reset(program);
    add_health(program);
    add_clean(program);
    add_check(program);
    add_keys(program);
    add_record(program);
    add_replay(program);
    add_layout(program);
    add_design(program);
    add_assess(program);
    add_propagate(program);
    add_simulate(program);
    add_vessel(program);
    add_calibrate(program);
    add_diagnose(program);
}

int run_quorient(int argc, char** argv)
{
    Program program{"quorient", "Quorient: a fault-tolerant attitude pipeline.\nAxes are 0-based: the papers' G2 is axis 1."};
    program.footer("Every verb has --help with an example, e.g. quorient assess --help");
    add_verbs(program);
    return program.run({argv + 1, argv + argc});
}

}  // namespace quorient::cli
