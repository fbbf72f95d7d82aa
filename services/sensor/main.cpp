#include "sensor_process.hpp"

int main(int argc, char** argv)
{
    return quorient::host::run(argc, argv, {"Publishes a unit's gyro frames: simulated, or from a log.", "sensor", quorient::sensor::find_process});
}
