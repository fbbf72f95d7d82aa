#include "guaranteed_comparison.hpp"

#include "quorient/geometry/parity_space.hpp"

#include <algorithm>
#include <bit>
#include <cmath>

namespace quorient::fdi {

namespace {

/// Whether | |v'z| - sigma |v|_1 | < 1e-5 sigma for some four axes.
bool near_boundary(const std::vector<geometry::AxisVector>& invariants, double bound, const std::vector<double>& z)
{
    const Eigen::Map<const Eigen::VectorXd> measured(z.data(), static_cast<Eigen::Index>(z.size()));
    return std::any_of(invariants.begin(), invariants.end(), [&](const geometry::AxisVector& v) {
        return std::abs(std::abs(v.dot(measured)) - bound * v.cwiseAbs().sum()) < 1e-5 * bound;
    });
}

}  // namespace

Comparison compare(GuaranteedDetector& detector, GuaranteedPrograms& programs, const geometry::Axes& axes, double bound,
                   const std::vector<std::vector<double>>& frames)
{
    std::vector<geometry::AxisVector> invariants;
    for (AxisMask four = 0; four < 64; ++four)
        if (std::popcount(four) == 4) invariants.push_back(geometry::ParitySpace(axes, four).basis().row(0).transpose());

    Comparison result;
    Assessment assessment;
    for (const auto& z : frames) {
        ++result.frames;
        if (near_boundary(invariants, bound, z)) {
            ++result.at_the_boundary;
            continue;
        }
        detector.assess({.identity = {}, .increment = z, .valid = all_axes(z.size())}, assessment);
        const auto hull = programs.solve(z, GuaranteedPrograms::Start::standard_basis);
        if (detector.empty() == hull.has_value()) ++result.emptiness_differs;
        else if (detector.empty()) ++result.empty;
        else
            for (std::size_t axis = 0; axis < z.size(); ++axis)
                result.largest_difference =
                    std::max({result.largest_difference, std::abs(detector.interval(axis).lower - hull->lower[axis]),
                              std::abs(detector.interval(axis).upper - hull->upper[axis])});
    }
    return result;
}

}  // namespace quorient::fdi
