#include "composition.hpp"

#include "quorient/runtime/log.hpp"

int main(int argc, char** argv)
{
    return quorient::runtime::guarded(quorient::composition::run, argc, argv);
}
