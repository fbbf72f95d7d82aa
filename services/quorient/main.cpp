#include "quorient/runtime/log.hpp"
#include "verbs/verbs.hpp"

#include <string>
#include <vector>

namespace {

int run(int argc, char** argv)
{
    quorient::cli::Program program{"quorient", "Quorient: a fault-tolerant attitude pipeline.\nAxes are 0-based: the papers' G2 is axis 1."};
    program.footer("Every verb has --help with an example, e.g. quorient assess --help");
    quorient::cli::add_verbs(program);
    return program.run({argv + 1, argv + argc});
}

}  // namespace

int main(int argc, char** argv)
{
    return quorient::runtime::guarded(run, argc, argv);
}
