#pragma once

#include "quorient/geometry/parity_space.hpp"

namespace quorient::design {

struct Probabilities {
    double false_alarm = 1e-6;  ///< that one sample raises an alarm without a fault
    double success = 0.99;      ///< that a fault is detected, or isolated
};

/// Faults of one sample, in sigma of their axis; infinite where no size suffices. [paper 004; docs/methods, what a single frame can show]
struct FaultSizes {
    double detected_axis = 0;  ///< on the worst axis: S0 exceeds its limit with the probability of success
    double isolated_axis = 0;  ///< on the worst axis: … and the likelihood ratio names that axis; at most this (a sum over rivals)
    double detected_pair = 0;  ///< two equal faults, the worst pair and signs: S0 exceeds its limit
    double isolated_pair = 0;  ///< two equal faults, the worst pair, signs and rival pair: no method can tell them at smaller sizes
};

/// P(S0 > limit) for a fault of this size: S0 is chi-square of `redundancy` degrees, shifted by visibility size^2.
/// @param visibility  f'Pf of the fault of size 1, for one axis P_ii
double detection_probability(unsigned redundancy, double visibility, double size, double false_alarm);

/// The size at which that is `probabilities.success`; infinite where nothing is visible.
double detected_size(unsigned redundancy, double visibility, const Probabilities& probabilities);

/// A lower bound of the probability that a fault of this size on this axis is detected and the axis explains more than any other:
/// 1 - P(missed) - sum over rivals of P(rival explains more), which for one rival is exact.
double isolation_probability(const geometry::ParitySpace& space, Eigen::Index axis, double size, double false_alarm);

/// Each of FaultSizes. @param space  of the whitened axes (rows over sigma).
double detected_axis(const geometry::ParitySpace& space, const Probabilities& probabilities);
double isolated_axis(const geometry::ParitySpace& space, const Probabilities& probabilities);
double detected_pair(const geometry::ParitySpace& space, const Probabilities& probabilities);
double isolated_pair(const geometry::ParitySpace& space, const Probabilities& probabilities);
FaultSizes fault_sizes(const geometry::ParitySpace& space, const Probabilities& probabilities);

}  // namespace quorient::design
