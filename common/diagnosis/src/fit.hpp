#pragma once

#include "mounting.hpp"
#include "overview.hpp"

#include <Eigen/Core>
#include <optional>

namespace quorient::diagnosis {

/// What one instrument makes of the motion that others agree on, along its own axes: y = bias + gain u.
struct Fit {
    Eigen::Vector3d bias_rad_s;
    Eigen::Matrix3d gain;
    Eigen::Vector3d gain_sigma;  ///< for the diagonal's terms
};

/// Robust least squares over the blocks: large residuals count less, and directions in which nothing moved are not moved by noise.
/// @param others  bit m: instrument m is part of the consensus
/// @returns nothing where nobody else has data
std::optional<Fit> fit_against(const Overview& overview, const Mountings& mountings, std::size_t m, std::uint32_t others);

}  // namespace quorient::diagnosis
