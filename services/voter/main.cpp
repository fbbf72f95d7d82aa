#include "voter_process.hpp"

int main(int argc, char** argv)
{
    return quorient::host::run(argc, argv, {"Chooses one attitude among the lanes and keeps it flowing.", "", quorient::voter::find_process});
}
