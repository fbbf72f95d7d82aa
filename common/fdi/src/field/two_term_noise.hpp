#pragma once

#include <algorithm>
#include <array>

namespace quorient::fdi::field {

/// A variance that is followed online in two terms, v = A + B q: A static, B in proportion to q, the variance that wandering sampling instants
/// make of the motion. Each is followed at two speeds (0.3 s and 3 s), and the larger one counts.
class TwoTermNoise {
public:
    static constexpr std::array memory_s{0.3, 3.0};

    /// The least B; for arrays like the MIMU4444 it is about 1.
    static constexpr double least_moving = 0.25;

    struct Term {
        double standing = 0;  ///< A
        double moving = 1;    ///< B
    };

    using Rates = std::array<double, memory_s.size()>;

    /// What one frame adds to each memory.
    static Rates rates(double interval_s)
    {
        constexpr double fastest = 0.5;
        return {std::min(fastest, interval_s / memory_s[0]), std::min(fastest, interval_s / memory_s[1])};
    }

    TwoTermNoise() = default;

    /// @param floor  the least A, and the first one
    explicit TwoTermNoise(double floor) { term_.fill({.standing = floor}); }

    double variance(double motion) const
    {
        double largest = 0;
        for (const Term& term : term_) largest = std::max(largest, term.standing + term.moving * motion);
        return largest;
    }

    const Term& slow() const { return term_.back(); }

    /// @param square  of one deviation, whose expectation is the variance
    void learn(double square, double motion, const Rates& rates, double floor)
    {
        for (std::size_t speed = 0; speed < term_.size(); ++speed) {
            Term& term = term_[speed];
            const double variance = term.standing + term.moving * motion;
            const double excess = truncation * std::min(largest_ratio, square / variance) - 1;
            const double share = term.standing / variance;
            term.standing = std::max(floor, term.standing * (1 + rates[speed] * share * excess));
            term.moving = std::max(least_moving, term.moving * (1 + rates[speed] * (1 - share) * excess));
        }
    }

private:
    /// A square beyond this many variances counts as so many: outliers are not noise.
    static constexpr double largest_ratio = 9;

    /// The mean of min(square / variance, largest_ratio) times this is 1.
    static constexpr double truncation = 1.05;

    std::array<Term, memory_s.size()> term_{};
};

}  // namespace quorient::fdi::field
