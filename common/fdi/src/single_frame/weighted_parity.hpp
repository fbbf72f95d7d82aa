#pragma once

#include "quorient/geometry/parity_space.hpp"

namespace quorient::fdi {

/// The parity space of axes that are not equally good: rows and measurements are divided by sigma_i / sigma, sigma the smallest one,
/// so that the noise is white. Where all sigma are equal this is the plain parity space, in the unit of z.
class WeightedParity {
public:
    /// @param sigma  of each axis, above 0.
    WeightedParity(const geometry::Axes& axes, const geometry::AxisVector& sigma, AxisMask used = ~AxisMask{0})
        : sigma_(sigma.minCoeff()), weight_(sigma_ * sigma.cwiseInverse()), space_(geometry::Axes(weight_.asDiagonal() * axes), used)
    {
    }

    /// p = V W z (q); its squared norm over sigma()^2 is chi-square of q degrees where there is no fault.
    geometry::AxisVector parity(const geometry::AxisVector& z) const { return space_.basis() * weight_.cwiseProduct(z); }

    /// r = P W z from p; 0 for unused axes.
    geometry::AxisVector residual(const geometry::AxisVector& parity) const { return space_.basis().transpose() * parity; }

    const geometry::ParitySpace& space() const { return space_; }
    const geometry::AxisVector& weight() const { return weight_; }  ///< sigma / sigma_i, at most 1
    double sigma() const { return sigma_; }
    unsigned redundancy() const { return static_cast<unsigned>(space_.redundancy()); }

private:
    double sigma_;
    geometry::AxisVector weight_;
    geometry::ParitySpace space_;
};

}  // namespace quorient::fdi
