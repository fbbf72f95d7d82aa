#include "detector_process.hpp"

int main(int argc, char** argv)
{
    return quorient::host::run(argc, argv, {"Detects and isolates faulty sensor axes: one verdict per frame.", "", quorient::detector::find_process});
}
