#pragma once

#include "field/two_term_noise.hpp"
#include "skewed/axis_parity.hpp"

namespace quorient::fdi::skewed {

/// How noisy the axes are right now, measured on their parity: variances of one axis in one frame [(rad/s)^2], as TwoTermNoise.
///
/// An axis is judged by the noise of the *others*: the parity that is left without it, which it does not enter. Its own noise, as far as it is
/// larger, widens its limits up to a bound: sound axes may be several times noisier than their neighbours. Where the others have no parity of
/// their own (four axes), the parity of all is what there is.
class AxisNoise {
public:
    AxisNoise(std::size_t axes, double floor_rad_s, double interval_s);

    void reset();

    /// The variances that hold for a frame with this motion.
    /// @param motion  q of every axis [(rad/s)^2]
    void reckon(const PerAxis& motion, const AxisParity& parity);

    double others(std::size_t axis) const { return others_[axis]; }
    double own(std::size_t axis) const { return own_[axis]; }
    double typical() const { return typical_; }  ///< the median of `others`

    /// What of this residual is no constant: its own mean over 0.3 s is taken out.
    PerAxis quick(const PerAxis& residual) const;

    /// @param quick  residuals without their means
    /// @param clipped  residuals that the means follow
    void learn(const AxisParity& parity, const PerAxis& quick, const PerAxis& clipped);

private:
    std::size_t count_;
    double floor_;  ///< A is at least this [(rad/s)^2]
    field::TwoTermNoise::Rates rate_;
    double mean_rate_;
    std::array<field::TwoTermNoise, max_axes> without_;  ///< for the parity without this axis
    std::array<field::TwoTermNoise, max_axes> along_;    ///< for the parity along this axis
    PerAxis motion_without_{};
    PerAxis motion_along_{};
    PerAxis mean_{};
    PerAxis others_{};
    PerAxis own_{};
    double typical_ = 0;
};

}  // namespace quorient::fdi::skewed
