#include "four_axes/polynomial_extrapolation.hpp"

#include <array>
#include <cassert>

namespace quorient::fdi {
namespace {

constexpr std::size_t highest_order = 3;

struct GramPolynomials {
    std::array<double, highest_order + 1> beta{};
    std::array<double, highest_order + 1> squared_norm{};

    explicit GramPolynomials(double length)
    {
        squared_norm[0] = length;
        for (std::size_t k = 1; k <= highest_order; ++k) {
            const double square = static_cast<double>(k * k);
            beta[k] = square * (length * length - square) / (4 * (4 * square - 1));
            squared_norm[k] = beta[k] * squared_norm[k - 1];
        }
    }

    std::array<double, highest_order + 1> at(double x) const
    {
        std::array<double, highest_order + 1> value{1, x};
        for (std::size_t k = 1; k < highest_order; ++k) value[k + 1] = x * value[k] - beta[k] * value[k - 1];
        return value;
    }
};

}  // namespace

void extrapolation_weights(std::size_t order, double horizon, std::span<double> weights)
{
    assert(order <= highest_order && weights.size() > order);
    const auto length = static_cast<double>(weights.size());
    const GramPolynomials polynomials(length);
    const double centre = (length - 1) / 2;
    const auto target = polynomials.at(centre + horizon);
    for (std::size_t i = 0; i < weights.size(); ++i) {
        const auto here = polynomials.at(static_cast<double>(i) - centre);
        weights[i] = 0;
        for (std::size_t k = 0; k <= order; ++k) weights[i] += target[k] * here[k] / polynomials.squared_norm[k];
    }
}

}  // namespace quorient::fdi
