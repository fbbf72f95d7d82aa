#pragma once

#include "quorient/attitude/update.hpp"

#include <array>
#include <cstddef>
#include <span>

namespace quorient::attitude {

/// Gauss-Legendre nodes on one interval: collocation at K of them leaves about x^(2K+1) (K!)^2 / ((2K)! (2K+1)!) of a rotation
/// by x, i.e. 3e-14 at 2 rad in one sample with 8 (1e-9 with 6).
inline constexpr std::size_t node_count = 8;

using NodeRow = Eigen::Array<double, static_cast<int>(node_count), 1>;

/// The Gauss-Legendre rule on [0, 1] and what integrates a polynomial through its nodes.
struct GaussRule {
    NodeRow weight;
    std::array<NodeRow, node_count> integral;  ///< [l][k]: the integral of Lagrange polynomial l from 0 to node k
};

const GaussRule& gauss_rule();

/// From the increments of `order` neighbouring samples to the body rate inside one of them: half the rate, times that sample's
/// interval, at its Gauss nodes = sum over j of weight[j][node] * increment_j.
///
/// The rate is the polynomial of degree order - 1 whose integrals over the samples are the increments, i.e. the derivative of
/// the polynomial that interpolates the accumulated angle at the samples' ends (Lagrange form, centred and scaled by the
/// target's interval, long double).
struct RateFit {
    std::array<NodeRow, longest_memory> weight;  ///< one row for each sample fitted; the rest is not set
};

/// @param intervals  of the samples fitted, oldest first, 1 .. 12 of them, all above 0
/// @param target     the sample, of these, in which the rate is wanted
RateFit fit_rate(std::span<const double> intervals, std::size_t target);

/// fit_rate for equal intervals, computed once per process. target < order <= 12.
const RateFit& equal_fit(std::size_t order, std::size_t target);

}  // namespace quorient::attitude
