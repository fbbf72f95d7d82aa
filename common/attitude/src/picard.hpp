#pragma once

#include "polynomial_fit.hpp"

#include <span>

namespace quorient::attitude {

/// The body rate inside one sample at its Gauss nodes: half of it, times the sample's interval [rad].
struct HalfRate {
    NodeRow x = NodeRow::Zero();
    NodeRow y = NodeRow::Zero();
    NodeRow z = NodeRow::Zero();

    /// Largest norm over the nodes, squared.
    double largest_squared() const { return (x * x + y * y + z * z).maxCoeff<Eigen::PropagateNaN>(); }
};

/// The fitted rate of `samples` (as many as the fit was made for).
HalfRate half_rate(const RateFit& fit, std::span<const Sample> samples);

/// Largest half rate for which picard() is worth its price: beyond 4 rad in one sample the motion is not resolved anyway.
inline constexpr double largest_half_rate = 2;

/// The rotation over the sample: the solution of q' = 1/2 q o omega, q(0) = 1, by Picard's iteration q <- 1 + 1/2 integral of
/// q o omega (docs/methods/coning.md, "Functional iteration") on polynomials through the Gauss nodes, iterated until the a-priori
/// bound U^i / i! of what is left is below rounding.
Quaternion picard(const HalfRate& rate);

}  // namespace quorient::attitude
