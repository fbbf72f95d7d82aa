#include "quorient/runtime/log.hpp"
#include "quorient/runtime/options.hpp"
#include "verbs/verbs.hpp"

namespace {

int run(int argc, char** argv)
{
    CLI::App program{"Quorient: a fault-tolerant attitude pipeline.\nAxes are 0-based: the papers' G2 is axis 1."};
    program.set_version_flag("--version", quorient::runtime::version());
    program.require_subcommand(1);
    program.footer("Every verb has --help with an example, e.g. quorient assess --help");
    quorient::cli::add_verbs(program);
    try {
        program.parse(argc, argv);
    } catch (const CLI::RuntimeError& error) {
        return error.get_exit_code();
    } catch (const CLI::ParseError& error) {
        return program.exit(error) == 0 ? 0 : 2;
    }
    return 0;
}

}  // namespace

int main(int argc, char** argv)
{
    return quorient::runtime::guarded(run, argc, argv);
}
