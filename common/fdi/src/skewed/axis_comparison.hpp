#pragma once

#include "field/comparison.hpp"
#include "field/erratic.hpp"
#include "field/learning.hpp"
#include "skewed/axis_noise.hpp"
#include "skewed/axis_sums.hpp"

namespace quorient::fdi::skewed {

/// One frame after the other: what each axis measures beyond what a rotation explains, in units that the filters sum.
///
///   r = P (z - theta phi),   phi = [1, dz(omega), dz(alpha)]
///
/// clipped as a whole, so that it keeps its direction in the parity space. theta, what is learned of each axis, is learned from r: only what the
/// parity shows of it is observable. All the rest is as field::Comparison.
class AxisComparison {
public:
    AxisComparison(const geometry::Axes& axes, double interval_s, const field::Allowed& allowed, const FieldRules& rules);

    void reset();

    /// Nothing is learned; the allowances are those of the class. @param rested  the biases of a resting second are taken out.
    void begin(bool rested);

    /// A newcomer of which nothing is known: the allowances widen to those of the start.
    void admit(std::size_t axis, bool rested);

    /// Time passed in which nothing could be learned.
    void wander(double seconds) { field::wander_within(allowance_, allowed_, seconds); }

    /// The body's rate by least squares without what is learned.
    /// @param last  the rate before
    Eigen::Vector3d rate(const PerAxis& rates, const AxisParity& parity, const Eigen::Vector3d& last) const;

    /// The same of the others, of a frame with this rate of all.
    Eigen::Vector3d rate_without(std::size_t axis, const PerAxis& rates, const AxisParity& parity, const Eigen::Vector3d& last) const;

    struct Input {
        const PerAxis& rates;      ///< biases of the start taken out [rad/s]
        AxisSet compared;          ///< take part in the comparison
        const AxisParity& parity;  ///< for those that have data in this frame
        bool learns = false;
    };

    /// Adds one frame to the sums.
    void add(const field::Motion& motion, const Input& input);

    const AxisWindows& sums() const { return sums_; }
    const field::Erratic& erratic() const { return erratic_; }
    const AxisNoise& noise() const { return noise_; }
    const Allowance& allowance() const { return allowance_; }
    const field::Allowed& allowed() const { return allowed_; }
    const Regressors& learned(std::size_t axis) const { return learned_[axis]; }

    /// The newest frame's residuals, not clipped [rad/s].
    const PerAxis& residual() const { return residual_; }

    /// What the residual of an axis stays below in one frame while it is sound [rad/s].
    double frame_bound() const { return frame_bound_; }

private:
    Regressors prior(bool rested) const;
    PerAxis unlearned(const PerAxis& rates, const Regressors& regressors, AxisSet set) const;
    Regressors regressors_of(const field::Motion& motion) const;
    PerAxis wander_of(const field::Motion& motion) const;
    PerAxis clipped(double allowance, const AxisParity& parity) const;
    AxisSet off(const PerAxis& quick, double quick_allowance, const AxisParity& parity) const;
    void add_to_sums(const Regressors& regressors, double weight, const PerAxis& clipped, AxisSet compared);
    void learn(const Regressors& regressors, const AxisParity& parity);

    geometry::Axes axes_;
    std::size_t count_;
    double interval_s_;
    double floor_;  ///< the least noise of one frame [rad/s]
    field::Allowed allowed_;
    FieldRules rules_;
    Regressors floor_variances_;
    Allowance allowance_;
    std::array<Regressors, max_axes> learned_;
    AxisNoise noise_;
    field::Erratic erratic_;
    AxisWindows sums_;
    PerAxis residual_{};
    double frame_bound_ = 0;
};

}  // namespace quorient::fdi::skewed
