#include "integrator_process.hpp"

int main(int argc, char** argv)
{
    return quorient::host::run(argc, argv, {"Integrates the trusted axes: one attitude per frame.", "", quorient::integrator::find_process});
}
