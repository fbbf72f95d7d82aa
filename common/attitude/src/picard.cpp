#include "picard.hpp"

#include <algorithm>
#include <cmath>

namespace quorient::attitude {
namespace {

// After i iterations the error is at most U^(i+1) / (i+1)!, U the largest half rate.
int iterations_for(double largest)
{
    constexpr double negligible = 1e-18;
    double bound = largest;
    int done = 0;
    while (bound > negligible) bound *= largest / (++done + 1);
    return std::max(done, 1);
}

using Curve = std::array<NodeRow, 4>;  // a quaternion at every node

// q o (0, u) at every node.
void times_rate(const Curve& q, const HalfRate& rate, Curve& result)
{
    const auto& u = rate.component;
    for (std::size_t k = 0; k < node_count; ++k) {
        result[0][k] = -q[1][k] * u[0][k] - q[2][k] * u[1][k] - q[3][k] * u[2][k];
        result[1][k] = q[0][k] * u[0][k] + q[2][k] * u[2][k] - q[3][k] * u[1][k];
        result[2][k] = q[0][k] * u[1][k] + q[3][k] * u[0][k] - q[1][k] * u[2][k];
        result[3][k] = q[0][k] * u[2][k] + q[1][k] * u[1][k] - q[2][k] * u[0][k];
    }
}

}  // namespace

double HalfRate::largest_squared() const
{
    double largest = 0;
    for (std::size_t k = 0; k < node_count; ++k) {
        const double squared = component[0][k] * component[0][k] + component[1][k] * component[1][k] + component[2][k] * component[2][k];
        largest = squared <= largest ? largest : squared;  // also keeps a NaN
    }
    return largest;
}

HalfRate half_rate(const RateFit& fit, std::span<const Sample> samples)
{
    HalfRate rate;
    for (std::size_t j = 0; j < samples.size(); ++j)
        for (std::size_t axis = 0; axis < 3; ++axis) {
            const double increment = samples[j].increment[static_cast<Eigen::Index>(axis)];
            for (std::size_t k = 0; k < node_count; ++k) rate.component[axis][k] += fit.weight[j][k] * increment;
        }
    return rate;
}

Quaternion picard(const HalfRate& rate)
{
    const GaussRule& rule = gauss_rule();
    Curve q{};
    q[0].fill(1);
    Curve slope;
    times_rate(q, rate, slope);
    for (int left = iterations_for(std::sqrt(rate.largest_squared())); left > 1; --left) {
        for (std::size_t c = 0; c < 4; ++c) {
            NodeRow sum{};
            for (std::size_t l = 0; l < node_count; ++l)
                for (std::size_t k = 0; k < node_count; ++k) sum[k] += rule.integral[l][k] * slope[c][l];
            q[c] = sum;
        }
        for (std::size_t k = 0; k < node_count; ++k) q[0][k] += 1;
        times_rate(q, rate, slope);
    }

    std::array<double, 4> end{};
    for (std::size_t c = 0; c < 4; ++c)
        for (std::size_t l = 0; l < node_count; ++l) end[c] += rule.weight[l] * slope[c][l];
    return {1 + end[0], end[1], end[2], end[3]};
}

}  // namespace quorient::attitude
