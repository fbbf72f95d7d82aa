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

// A quaternion at every node.
struct Curve {
    NodeRow w, x, y, z;
};

// q o (0, u) at every node.
Curve times_rate(const Curve& q, const HalfRate& u)
{
    return {-q.x * u.x - q.y * u.y - q.z * u.z, q.w * u.x + q.y * u.z - q.z * u.y, q.w * u.y + q.z * u.x - q.x * u.z,
            q.w * u.z + q.x * u.y - q.y * u.x};
}

// 1 + the integral of `slope` from the sample's begin to every node.
Curve integrated(const Curve& slope)
{
    const auto& integral = gauss_rule().integral;
    Curve q{NodeRow::Ones(), NodeRow::Zero(), NodeRow::Zero(), NodeRow::Zero()};
    for (std::size_t l = 0; l < node_count; ++l) {
        const auto node = static_cast<Eigen::Index>(l);
        q.w += integral[l] * slope.w[node];
        q.x += integral[l] * slope.x[node];
        q.y += integral[l] * slope.y[node];
        q.z += integral[l] * slope.z[node];
    }
    return q;
}

}  // namespace

HalfRate half_rate(const RateFit& fit, std::span<const Sample> samples)
{
    HalfRate rate;
    for (std::size_t j = 0; j < samples.size(); ++j) {
        rate.x += fit.weight[j] * samples[j].increment.x();
        rate.y += fit.weight[j] * samples[j].increment.y();
        rate.z += fit.weight[j] * samples[j].increment.z();
    }
    return rate;
}

Quaternion picard(const HalfRate& rate)
{
    Curve slope{NodeRow::Zero(), rate.x, rate.y, rate.z};  // the slope at q = 1
    for (int left = iterations_for(std::sqrt(rate.largest_squared())); left > 1; --left) slope = times_rate(integrated(slope), rate);

    const NodeRow& weight = gauss_rule().weight;
    return {1 + (weight * slope.w).sum(), (weight * slope.x).sum(), (weight * slope.y).sum(), (weight * slope.z).sum()};
}

}  // namespace quorient::attitude
