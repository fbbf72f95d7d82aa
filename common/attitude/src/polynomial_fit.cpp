#include "polynomial_fit.hpp"

#include <cassert>
#include <cmath>
#include <memory>
#include <numbers>

namespace quorient::attitude {
namespace {

using Wide = long double;
using WideRow = std::array<Wide, node_count>;

struct Legendre {
    Wide value;
    Wide derivative;
};

Legendre legendre(Wide x)
{
    Wide before = 1;
    Wide value = x;
    for (std::size_t n = 2; n <= node_count; ++n) {
        const Wide next = (static_cast<Wide>(2 * n - 1) * x * value - static_cast<Wide>(n - 1) * before) / static_cast<Wide>(n);
        before = value;
        value = next;
    }
    return {value, static_cast<Wide>(node_count) * (x * value - before) / (x * x - 1)};
}

struct WideRule {
    WideRow node{};
    WideRow weight{};

    WideRule()
    {
        for (std::size_t k = 0; k < node_count; ++k) {
            Wide x = -std::cos(std::numbers::pi_v<Wide> * (static_cast<Wide>(k) + 0.75L) / (node_count + 0.5L));
            for (int newton = 0; newton < 10; ++newton) x -= legendre(x).value / legendre(x).derivative;
            const Wide slope = legendre(x).derivative;
            node[k] = (x + 1) / 2;
            weight[k] = 1 / ((1 - x * x) * slope * slope);
        }
    }

    Wide lagrange(std::size_t l, Wide x) const
    {
        Wide product = 1;
        for (std::size_t m = 0; m < node_count; ++m)
            if (m != l) product *= (x - node[m]) / (node[l] - node[m]);
        return product;
    }

    // The integral of Lagrange polynomial l from 0 to `end`: its degree is below the rule's, so the rule is exact.
    Wide integral(std::size_t l, Wide end) const
    {
        Wide sum = 0;
        for (std::size_t k = 0; k < node_count; ++k) sum += weight[k] * lagrange(l, node[k] * end);
        return sum * end;
    }
};

const WideRule& wide_rule()
{
    static const WideRule rule;
    return rule;
}

// Ends of the samples, from the target's begin, in units of the target's interval.
std::array<Wide, longest_memory + 1> scaled_ends(std::span<const double> intervals, std::size_t target)
{
    std::array<Wide, longest_memory + 1> end{};
    for (std::size_t i = target; i < intervals.size(); ++i) end[i + 1] = end[i] + static_cast<Wide>(intervals[i]) / intervals[target];
    for (std::size_t i = target; i > 0; --i) end[i - 1] = end[i] - static_cast<Wide>(intervals[i - 1]) / intervals[target];
    return end;
}

struct EqualFits {
    std::array<std::array<RateFit, longest_memory>, longest_memory> fit;

    EqualFits()
    {
        std::array<double, longest_memory> ones{};
        ones.fill(1);
        for (std::size_t order = 1; order <= longest_memory; ++order)
            for (std::size_t target = 0; target < order; ++target)
                fit[order - 1][target] = fit_rate(std::span<const double>(ones).first(order), target);
    }
};

}  // namespace

const GaussRule& gauss_rule()
{
    static const GaussRule rule = [] {
        GaussRule rounded;
        for (std::size_t k = 0; k < node_count; ++k) {
            const auto row = static_cast<Eigen::Index>(k);
            rounded.weight[row] = static_cast<double>(wide_rule().weight[k]);
            for (std::size_t l = 0; l < node_count; ++l)
                rounded.integral[l][row] = static_cast<double>(wide_rule().integral(l, wide_rule().node[k]));
        }
        return rounded;
    }();
    return rule;
}

RateFit fit_rate(std::span<const double> intervals, std::size_t target)
{
    assert(!intervals.empty() && intervals.size() <= longest_memory && target < intervals.size());
    const std::size_t ends = intervals.size() + 1;
    const auto end = scaled_ends(intervals, target);

    std::array<Wide, longest_memory + 1> scale{};  // 1 / product of (end_i - end_n)
    for (std::size_t i = 0; i < ends; ++i) {
        Wide product = 1;
        for (std::size_t n = 0; n < ends; ++n)
            if (n != i) product *= end[i] - end[n];
        scale[i] = 1 / product;
    }

    RateFit fit;
    for (std::size_t k = 0; k < node_count; ++k) {
        // Slope of Lagrange polynomial i at x:  l_i'(x) = l_i(x) * sum over n != i of 1 / (x - end_n). A Gauss node is never an end.
        const Wide x = wide_rule().node[k];
        std::array<Wide, longest_memory + 1> inverse{};
        Wide product = 1;
        Wide sum = 0;
        for (std::size_t n = 0; n < ends; ++n) {
            inverse[n] = 1 / (x - end[n]);
            product *= x - end[n];
            sum += inverse[n];
        }
        // Increment j raises the accumulated angle at all later ends.
        Wide rate = 0;
        for (std::size_t j = intervals.size(); j-- > 0;) {
            rate += scale[j + 1] * product * inverse[j + 1] * (sum - inverse[j + 1]);
            fit.weight[j][static_cast<Eigen::Index>(k)] = static_cast<double>(rate / 2);
        }
    }
    return fit;
}

const RateFit& equal_fit(std::size_t order, std::size_t target)
{
    static const auto fits = std::make_unique<const EqualFits>();
    assert(target < order && order <= longest_memory);
    return fits->fit[order - 1][target];
}

}  // namespace quorient::attitude
