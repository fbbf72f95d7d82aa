#pragma once

#include "quorient/fdi/detector.hpp"
#include "single_frame/weighted_parity.hpp"

#include <array>

namespace quorient::fdi {

/// The decision about one faulty axis, whichever way its statistics were computed: the generalised likelihood ratio test of Daly, Gai &
/// Harrison, Potter & Suman's "thresholdless" isolation, and the largest normalised n-equation residual are the same one. [paper 004]
///
///   S0 / sigma^2 <= chi-square limit of q degrees: healthy. Else the axis that explains most, D_i = r_i^2 / P_ii, is named, unless
///   - another explains as much within the margin (in units of sigma^2): ambiguous, with all of those;
///   - what it leaves, S0 - D_i, is beyond the limit of q - 1 degrees: blind, for no single axis explains the frame.
class SingleFaultRule {
public:
    SingleFaultRule(double pfa, double margin);

    /// Fills outcome, isolated, candidates, statistic, threshold, bound.
    /// @param sum_of_squares  S0
    /// @param explained       D_i, 0 for axes that are not in use or leave no trace
    void judge(const WeightedParity& parity, double sum_of_squares, const geometry::AxisVector& explained, Assessment& assessment) const;

private:
    double margin_;
    std::array<double, max_axes> limit_{};  ///< chi-square, by degrees of freedom
};

}  // namespace quorient::fdi
