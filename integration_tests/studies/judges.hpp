#pragma once

#include "monte_carlo.hpp"
#include "quorient/fdi/settings.hpp"

namespace quorient::studies {

/// A method of the product as fdi::make_detector makes it; healthy and isolated are decisions, everything else is a flag.
JudgeFactory method(const fdi::DetectorSettings& settings);

/// Bounds, not methods: they know the number of faults. [docs/methods/subset_likelihood.md]
///   likelihood:   argmin S_w over the sets of that size, S_w = S0 - r_w'(P_ww)^-1 r_w;
///   posterior:    argmin S_w + log det P_ww - 2 log(share of N(f_w, (P_ww)^-1) within the sizes that the faults are drawn from): the
///                 posterior with a flat prior (two faults taken as independent in the last term).
/// For one or two faults; nothing is decided without a fault.
JudgeFactory likelihood_of_known_count();
JudgeFactory posterior_of_known_count();

/// Invariants by the exact patterns, with a tolerance in proportion to each quadruple's weights: T_w = factor x sum |v_w|, v_w of unit
/// norm. (The product's method has one tolerance for all quadruples; so has the fit of paper 002 on the dodecahedron only.)
JudgeFactory invariants_by_weight_sum(double factor);

/// Voting by the exact patterns, where two triads agree if each component of their difference is within `sigmas` of its own standard
/// deviation. (The product's method compares Euclidean norms, as the paper does.)
JudgeFactory voting_by_component(double sigmas);

}  // namespace quorient::studies
