// A consumer of the installed package: isolates a biased gyro of the dodecahedron and prints its axis.

#include <quorient/rotation/quaternion.hpp>
#include <quorient/fdi/methods.hpp>
#include <quorient/geometry/layouts.hpp>
#include <quorient/recording/reader.hpp>
#include <quorient/simulation/faults.hpp>
#include <quorient/voting/voter.hpp>

#include <bit>
#include <cstdio>
#include <vector>

int main()
{
    using namespace quorient;
    const auto cluster = geometry::layout("dodecahedron");
    const auto fault = simulation::parse_fault("axis=2,kind=bias,value=0.1,start=0");
    if (!cluster || !fault || voting::check({}) || recording::open_log("/nonexistent")) return 1;
    auto detector = fdi::make_detector({.method = "glt", .sigma = 1e-6, .pfa = 1e-6}, *cluster);
    if (!detector) return 2;

    const auto& axes = cluster->axes;
    const auto turn = rotation::from_rotation_vector({0.01, -0.02, 0.03});
    std::vector<double> increment;
    for (Eigen::Index i = 0; i < axes.rows(); ++i) increment.push_back(2 * axes.row(i).dot(turn.vec()) + (i == 2 ? 5e-4 : 0));
    fdi::Assessment assessment;
    (*detector)->assess({.identity = {1, 1}, .interval_s = 0.005, .increment = increment, .valid = 0b111111}, assessment);
    std::printf("%d\n", std::countr_zero(assessment.isolated));
    return 0;
}
