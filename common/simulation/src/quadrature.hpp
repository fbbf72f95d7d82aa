#pragma once

#include <Eigen/Core>
#include <boost/math/quadrature/gauss.hpp>
#include <cmath>

namespace quorient::simulation {

/// The integral of a vector function over [begin, begin + duration], by 10-point Gauss-Legendre panels of at most one radian of its
/// highest angular frequency: the truncation error is then below 1e-25 of the integrand, so only rounding is left.
template <class Function>
Eigen::Vector3d integrate(const Function& function, double begin, double duration, double highest_frequency_rad_s)
{
    using Rule = boost::math::quadrature::gauss<double, 10>;
    const int panels = std::max(1, static_cast<int>(std::ceil(std::abs(duration) * highest_frequency_rad_s)));
    const double half = duration / (2.0 * panels);
    Eigen::Vector3d sum = Eigen::Vector3d::Zero();
    for (int panel = 0; panel < panels; ++panel) {
        const double centre = begin + (2 * panel + 1) * half;
        for (std::size_t i = 0; i < Rule::abscissa().size(); ++i) {  // the rule is symmetric: only the positive nodes are listed
            const double offset = half * Rule::abscissa()[i];
            sum += Rule::weights()[i] * (function(centre - offset) + function(centre + offset));
        }
    }
    return half * sum;
}

}  // namespace quorient::simulation
