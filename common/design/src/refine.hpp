#pragma once

#include "arrangement.hpp"
#include "minimise.hpp"
#include "quorient/design/brief.hpp"
#include "quorient/design/figures.hpp"
#include "terms.hpp"

#include <vector>

namespace quorient::design {

/// What a local search improves.
struct Aim {
    Objective objective = Objective::trace;
    unsigned failures = 0;          ///< before the worst case is taken
    bool keep_accuracy = false;     ///< the trace without failures first; then the objective, without giving up any of it
    double trace_at_most = 0;       ///< 0: free
};

/// The aims of a search: accuracy first and then each of the others, each of the others alone, and what lies between.
/// Those with derivatives; see has_derivatives.
std::vector<Aim> aims_of(const Brief& brief, Objective objective);

/// Objectives that are refined by their derivatives. Others start from what these found.
bool has_derivatives(Objective objective);

/// Improves arrangements locally under the brief's constraints: smallest angle, limits, tilts.
class Refiner {
public:
    explicit Refiner(const Brief& brief);

    Eigen::VectorXd refine(const Arrangement& arrangement, const Eigen::VectorXd& start, const Aim& aim) const;

    /// By trial, for an objective without derivatives.
    Eigen::VectorXd refine_blindly(const Arrangement& arrangement, const Eigen::VectorXd& start, Objective objective,
                                   const Yardstick& yardstick) const;

private:
    Terms terms(const geometry::Axes& axes, const Aim& aim) const;
    Values of_axes(const Arrangement& arrangement, std::function<Terms(const geometry::Axes&)> terms) const;
    Terms by_axes(Terms by_rows) const;
    Values constraints(const Arrangement& arrangement, const Aim& aim) const;
    Eigen::VectorXd keep_trace(const Arrangement& arrangement, Eigen::VectorXd x, Aim aim, double trace) const;
    Terms limits(const geometry::Axes& axes) const;
    geometry::Axes whitened(const geometry::Axes& axes) const;

    Brief brief_;
    geometry::AxisVector weight_;                ///< 1 / noise
    std::vector<std::vector<AxisMask>> removed_;  ///< by number of failures
    std::vector<AxisPair> pairs_;                 ///< axes of different instruments
    double best_trace_;                           ///< that no array passes
};

}  // namespace quorient::design
