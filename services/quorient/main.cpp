#include "quorient/runtime/log.hpp"
#include "verbs/verbs.hpp"

int main(int argc, char** argv)
{
    return quorient::runtime::guarded(quorient::cli::run_quorient, argc, argv);
}
