#include "quorient/design/fault_size.hpp"

#include "numbers.hpp"

#include <Eigen/LU>
#include <algorithm>
#include <array>
#include <boost/math/distributions/chi_squared.hpp>
#include <boost/math/distributions/non_central_chi_squared.hpp>
#include <boost/math/distributions/normal.hpp>
#include <boost/math/tools/toms748_solve.hpp>
#include <cstdint>
#include <cmath>

namespace quorient::design {

namespace {

using Eigen::Index;

constexpr double invisible = 1e-12;
constexpr double indistinct = 1e-4;    // distance in parity space below which two sets of faults look alike
constexpr double largest_size = 1e4;   // sigma; what is not reached by then is called infinite
constexpr int precision_bits = 40;

/// Where an increasing probability reaches its goal; at least from `low`.
template <class Probability>
double size_reaching(double goal, double low, Probability probability)
{
    const auto excess = [&](double size) { return probability(size) - goal; };
    while (excess(low) > 0) low /= 2;
    double high = 2 * low;
    for (; excess(high) < 0; high *= 2)
        if (high > largest_size) return infinity;
    std::uintmax_t steps = 100;
    return boost::math::tools::toms748_solve(excess, low, high, boost::math::tools::eps_tolerance<double>(precision_bits), steps).second;
}

double below(double value)
{
    return boost::math::cdf(boost::math::normal(), value);
}

/// P(|b| > |a|), a ~ N(mean, 1) and b ~ N(correlation mean, 1) of this correlation: a^2 - b^2 is the product of two independent normals.
double rival_explains_more(double mean, double correlation)
{
    const double c = std::min(1.0, std::abs(correlation));
    const double difference = mean * std::sqrt((1 - c) / 2), sum = mean * std::sqrt((1 + c) / 2);
    return below(difference) * below(-sum) + below(-difference) * below(sum);
}

unsigned redundancy_of(const geometry::ParitySpace& space)
{
    return static_cast<unsigned>(space.redundancy());
}

/// Two axes have the same direction in parity space: whichever is wrong, the other one explains as much.
bool looks_like_another(const geometry::AxisMatrix& p)
{
    for (Index i = 0; i < p.rows(); ++i)
        for (Index j = 0; j < i; ++j)
            if (p(i, i) * p(j, j) - p(i, j) * p(i, j) < indistinct * indistinct * p(i, i) * p(j, j)) return true;
    return false;
}

template <class Visit>
void for_each_pair(Index n, Visit visit)
{
    for (Index i = 0; i < n; ++i)
        for (Index j = i + 1; j < n; ++j) visit(i, j);
}

/// f'Pf of two equal faults of size 1: the worst pair and signs.
double worst_pair_visibility(const geometry::AxisMatrix& p)
{
    double least = infinity;
    for_each_pair(p.rows(), [&](Index i, Index j) { least = std::min(least, p(i, i) + p(j, j) - 2 * std::abs(p(i, j))); });
    return least;
}

/// What two faults (+1, sign) on (i, j) leave that faults of any size on (k, l) do not explain: the distance in parity space, squared.
double unexplained(const geometry::AxisMatrix& p, Index i, Index j, double sign, Index k, Index l)
{
    const Eigen::Vector2d seen(p(i, k) + sign * p(j, k), p(i, l) + sign * p(j, l));
    Eigen::Matrix2d own;
    own << p(k, k), p(k, l), p(l, k), p(l, l);
    const double whole = p(i, i) + p(j, j) + 2 * sign * p(i, j);
    if (own.determinant() < invisible) {  // both rivals look alike: one of them
        const double best = std::max(own(0, 0) > invisible ? seen(0) * seen(0) / own(0, 0) : 0.0,
                                     own(1, 1) > invisible ? seen(1) * seen(1) / own(1, 1) : 0.0);
        return std::max(0.0, whole - best);
    }
    return std::max(0.0, whole - seen.dot(own.inverse() * seen));
}

double worst_pair_distance(const geometry::AxisMatrix& p)
{
    double least = infinity;
    const Index n = p.rows();
    for_each_pair(n, [&](Index i, Index j) {
        for_each_pair(n, [&](Index k, Index l) {
            if (k == i && l == j) return;
            for (const double sign : {-1.0, 1.0}) least = std::min(least, unexplained(p, i, j, sign, k, l));
        });
    });
    return std::sqrt(least);
}

}  // namespace

double detection_probability(unsigned redundancy, double visibility, double size, double false_alarm)
{
    const boost::math::chi_squared quiet(redundancy);
    const double limit = boost::math::quantile(boost::math::complement(quiet, false_alarm));
    const double shift = visibility * size * size;
    if (shift > 1e4) return 1;  // tens of standard deviations above any limit
    if (shift == 0) return false_alarm;
    return boost::math::cdf(boost::math::complement(boost::math::non_central_chi_squared(redundancy, shift), limit));
}

double detected_size(unsigned redundancy, double visibility, const Probabilities& probabilities)
{
    if (redundancy == 0 || visibility < invisible) return infinity;
    const double size = size_reaching(
        probabilities.success, 1, [&](double scaled) { return detection_probability(redundancy, 1, scaled, probabilities.false_alarm); });
    return size / std::sqrt(visibility);
}

double isolation_probability(const geometry::ParitySpace& space, Index axis, double size, double false_alarm)
{
    const auto& p = space.projector();
    const double own = p(axis, axis);
    double wrong = 1 - detection_probability(static_cast<unsigned>(space.redundancy()), own, size, false_alarm);
    for (Index rival = 0; rival < p.rows(); ++rival)
        if (rival != axis && p(rival, rival) > invisible)
            wrong += rival_explains_more(size * std::sqrt(own), p(axis, rival) / std::sqrt(own * p(rival, rival)));
    return 1 - wrong;
}

double detected_axis(const geometry::ParitySpace& space, const Probabilities& probabilities)
{
    if (space.redundancy() == 0) return infinity;
    return detected_size(redundancy_of(space), space.projector().diagonal().minCoeff(), probabilities);
}

double isolated_axis(const geometry::ParitySpace& space, const Probabilities& probabilities)
{
    const double detected = detected_axis(space, probabilities);
    if (detected == infinity || looks_like_another(space.projector())) return infinity;
    double largest = 0;
    for (Index axis = 0; axis < space.size(); ++axis) {
        const auto probability = [&](double size) { return isolation_probability(space, axis, size, probabilities.false_alarm); };
        largest = std::max(largest, size_reaching(probabilities.success, detected / 2, probability));
    }
    return largest;
}

double detected_pair(const geometry::ParitySpace& space, const Probabilities& probabilities)
{
    if (space.redundancy() == 0) return infinity;
    return detected_size(redundancy_of(space), worst_pair_visibility(space.projector()), probabilities);
}

double isolated_pair(const geometry::ParitySpace& space, const Probabilities& probabilities)
{
    if (space.redundancy() < 2) return infinity;
    const double distance = worst_pair_distance(space.projector());
    if (distance < indistinct) return infinity;
    return 2 * boost::math::quantile(boost::math::normal(), probabilities.success) / distance;
}

FaultSizes fault_sizes(const geometry::ParitySpace& space, const Probabilities& probabilities)
{
    return {detected_axis(space, probabilities), isolated_axis(space, probabilities), detected_pair(space, probabilities),
            isolated_pair(space, probabilities)};
}

}  // namespace quorient::design
