#pragma once

#include "quorient/fdi/observer_bank.hpp"
#include "quorient/messages/limits.hpp"

#include <Eigen/Core>
#include <string>
#include <tl/expected.hpp>
#include <vector>

namespace quorient::fdi {

/// K of the observer  xh' = A xh + B u + K (y - C xh)  whose error under a fault of `channel` moves in one direction:
/// l = K e_channel is an eigenvector of A - K. For two states, both measured (C = I), with k11 = 1.
///
/// Closed form (docs/methods/observers.md): l is parallel to a_channel - other_pole e_channel. With the feedthrough of the fault itself the
/// measured residual r = C e + f still moves in span{e_channel, l}; see contrast().
/// [paper 001, conditions 1 and 2, eqs 15-24 repaired]
///
/// @param fault_pole   the pole along the fault direction, below 0; @param other_pole  the other one, below 0.
/// @returns which denominator vanishes, or that the plant is not 2 x 2, or that a pole is not stable.
tl::expected<Eigen::Matrix2d, std::string> directional_gain(const Eigen::MatrixXd& a, Eigen::Index channel, double fault_pole,
                                                            double other_pole);

/// The three conditions of paper 001 for a directional bank, gains[i] for channel i, each refused with its own message:
/// 1 rank [l_i, (A - K_i) l_i] = 1; 2 A - K_i Hurwitz; 3 the l_i linearly independent.
tl::expected<void, std::string> check_conditions(const Eigen::MatrixXd& a, const std::vector<Eigen::MatrixXd>& gains);

/// By how much the right channel's metric C_i = |l_i' r_i| / |l_i| (eq 25) exceeds the largest other one's while a constant fault of
/// channel i lasts: steady[i], from r = (I + C (A - K C)^-1 K) e_i. Below 1 the metric names the wrong channel.
std::vector<double> contrast(const LinearPlant& plant, const std::vector<Eigen::MatrixXd>& gains);

/// K of an observer that does not use the channels of `blind`: these columns are 0, A - K C has the given poles as far as the other
/// outputs see the state; what they do not see must be stable by itself.
/// @returns that the pair (A, C without these rows) is not detectable (with the pole that nobody sees), or why placement failed.
tl::expected<Eigen::MatrixXd, std::string> blind_gain(const LinearPlant& plant, AxisMask blind, const Poles& poles);

}  // namespace quorient::fdi
