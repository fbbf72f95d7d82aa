#include "monitor_process.hpp"

int main(int argc, char** argv)
{
    return quorient::host::run(argc, argv, quorient::monitor::role());
}
