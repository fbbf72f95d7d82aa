#pragma once

#include "quorient/geometry/sensor_cluster.hpp"

#include <glpk.h>
#include <array>
#include <memory>
#include <optional>
#include <vector>

namespace quorient::fdi {

/// The guaranteed estimate of six axes as paper 000 states it, by GLPK's simplex method: for each of the 15 pairs and each axis i, two
/// linear programs,
///   max and min of h_i q  subject to  z_j - sigma <= h_j q <= z_j + sigma  for the four axes j outside the pair.
/// The 15 problem objects are made once; per frame only the bounds of their rows change. The presolver is off.
class GuaranteedPrograms {
public:
    enum class Start { standard_basis, last_basis };

    struct Hull {
        std::array<double, 6> lower{};
        std::array<double, 6> upper{};
    };

    GuaranteedPrograms(const geometry::Axes& axes, double bound);

    /// Solves all 180 programs. @returns nothing where every pair is infeasible.
    std::optional<Hull> solve(const std::vector<double>& z, Start start);

private:
    struct Delete {
        void operator()(glp_prob* problem) const { glp_delete_prob(problem); }
    };
    struct Pair {
        std::unique_ptr<glp_prob, Delete> problem;
        std::vector<std::size_t> axis;  ///< the four that are left
    };

    std::optional<double> optimum(const Pair& pair, std::size_t axis, int sense, Start start) const;

    geometry::Axes axes_;
    double bound_;
    std::vector<Pair> pairs_;
    glp_smcp parameters_{};
};

}  // namespace quorient::fdi
