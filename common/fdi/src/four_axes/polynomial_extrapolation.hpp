#pragma once

#include <cstddef>
#include <span>

namespace quorient::fdi {

/// The weights w with which a least-squares polynomial of `order` through equally spaced values y_0 .. y_{L-1} predicts the value
/// `horizon` places after the last one:  y(L - 1 + horizon) = sum w_i y_i.
///
/// By discrete (Gram) orthogonal polynomials in x = i - (L-1)/2, which keep full precision at any length:
///   P_{k+1} = x P_k - beta_k P_{k-1},   beta_k = k^2 (L^2 - k^2) / (4 (4 k^2 - 1)),   |P_k|^2 = beta_k |P_{k-1}|^2,  |P_0|^2 = L
///   w_i = sum_{k <= order} P_k(x_horizon) P_k(x_i) / |P_k|^2
/// @param weights  as long as the polynomial's base, more than `order`; order <= 3.
void extrapolation_weights(std::size_t order, double horizon, std::span<double> weights);

}  // namespace quorient::fdi
