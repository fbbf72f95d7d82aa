#pragma once

#include <array>
#include <cmath>
#include <cstddef>
#include <utility>

namespace quorient::calibration {

/// Terms of a motion noise (their logarithms), with the step and the statistic that they give.
template <std::size_t terms>
struct TermPlace {
    /// How much the logarithm of the smallest step grows when all terms are raised until the logarithm of the statistic falls by one.
    /// Recordings show 0.6 to 0.9.
    static constexpr double exchange = 0.8;

    std::array<double, terms> logs{};
    double step = 0;    ///< logarithm of the smallest detectable step
    double excess = 0;  ///< logarithm of the statistic over the wanted one
    double merit() const { return step + exchange * excess; }
};

struct TermSearchSettings {
    double close_enough = 0.01;  ///< tolerance of the excess
    int level_rounds = 12;
    int sweeps = 5;
};

/// Searches the terms without an excess for those with the smallest detectable step: a pattern search, which finds a local minimum.
template <std::size_t terms, class Seen>
class TermSearch {
public:
    using Place = TermPlace<terms>;

    /// @param seen  evaluates logarithms of terms to their place.
    TermSearch(Place start, Seen seen, const TermSearchSettings& settings) : at_(start), seen_(std::move(seen)), settings_(settings) {}

    std::array<double, terms> result()
    {
        level();
        for (const double factor : {0.6, 0.3})
            for (int sweep = 0; sweep < settings_.sweeps && improved(factor); ++sweep) level();
        return at_.logs;
    }

private:
    static constexpr double worth_a_step = 0.005;  ///< smallest gain in merit

    /// Scales all terms by one factor until the excess is zero.
    void level()
    {
        double lowest = -1e9;
        double highest = 1e9;
        double by = 0;
        const auto from = at_.logs;
        for (int round = 0; round < settings_.level_rounds && std::abs(at_.excess) > settings_.close_enough; ++round) {
            (at_.excess > 0 ? lowest : highest) = by;
            by += at_.excess;  // the statistic falls no faster than the terms rise
            if (by <= lowest || by >= highest) by = (lowest + highest) / 2;
            auto logs = from;
            for (double& value : logs) value += by;
            at_ = seen_(logs);
        }
    }

    /// Each term up or down by this factor. @returns whether any of that was worth its while.
    bool improved(double factor)
    {
        bool any = false;
        for (std::size_t term = 0; term < terms; ++term)
            for (const double by : {-factor, factor}) {
                auto logs = at_.logs;
                logs[term] += by;
                const Place there = seen_(logs);
                if (there.merit() > at_.merit() - worth_a_step) continue;
                at_ = there;
                any = true;
                break;
            }
        return any;
    }

    Place at_;
    Seen seen_;
    TermSearchSettings settings_;
};

}  // namespace quorient::calibration
