#pragma once

#include "field/parameters.hpp"
#include "quorient/fdi/settings.hpp"

#include <algorithm>

namespace quorient::fdi::field {

/// What sound sensors of an array may differ by before anything is learned.
struct Allowed {
    ClassFigures figures;
    bool calibrated = false;
    double delay_s = 0;        ///< standard deviation before anything is learned
    double delay_floor_s = 0;

    /// Standard deviations. @param rested  the biases of a resting second are taken out.
    double bias(bool rested) const
    {
        if (rested) return figures.bias_after_rest_rad_s;
        return calibrated ? figures.bias_calibrated_rad_s : figures.bias_unknown_rad_s;
    }
    double gain() const { return calibrated ? figures.gain_calibrated : figures.gain; }
};

Allowed allowed_by(const DetectorSettings& settings, double frame_interval_s);

/// Time passed in which nothing could be learned: biases, parameter 0, wander.
template <Eigen::Index Count>
void wander_within(Allowance<Count>& allowance, const Allowed& allowed, double seconds)
{
    const double wander = allowed.figures.bias_wander_rad_s_root_s;
    const double room = allowed.figures.bias_unknown_rad_s * allowed.figures.bias_unknown_rad_s - allowance.variance(0);
    if (room > 0) allowance.add_variance(0, std::min(room, wander * wander * seconds));
}

/// What sound instruments of an array may differ by, and what of it has been learned.
///
/// The differences are a prior covariance over Parameters, from the class: not a threshold, but an allowance that is carried through every
/// window. A Kalman filter per component learns them slowly, for all instruments with one covariance P; only differences between instruments
/// are observable, so what is learned sums to zero. A floor F stands for what may change without being learned. [allowance = phi'(P + F) phi]
class Learning {
public:
    Learning(std::size_t instruments, const Allowed& allowed);

    /// Nothing is learned; the allowances are those of the class. @param rested  the biases of a resting second are taken out.
    void reset(bool rested);

    /// A newcomer of which nothing is known: the allowances widen to those of the start, and its learned differences are zero.
    void admit(std::size_t m, bool rested);

    /// Time passed in which nothing could be learned: biases wander.
    void wander(double seconds);

    /// theta' phi
    double learned(std::size_t component, std::size_t m, const Parameters& regressors) const
    {
        return learned_[component][m].dot(regressors);
    }
    const Parameters& learned(std::size_t component, std::size_t m) const { return learned_[component][m]; }

    /// Variance of what a sound instrument may still differ by: phi'(P + F) phi, for a frame's regressors or for sums of them.
    double allowance(std::size_t component, const Parameters& regressors) const { return allowance_[component].of(regressors); }

    const Allowed& allowed() const { return allowed_; }

    /// Standard deviations of what one instrument may still differ by, the largest of all components.
    Parameters deviations() const;

    /// One step of the filter.
    /// @param residual  what is left of each instrument's deviation with what is learned taken out
    /// @param variance  of one frame's noise
    /// @param colour    times the variance: how many frames' noise is one independent piece of information
    void learn(std::size_t component, const Parameters& regressors, InstrumentSet present, const PerInstrument& residual, double variance,
               double colour, double interval_s);

    /// Without the instruments that are no longer compared: what the others have in common is unobservable, and goes.
    void centre(InstrumentSet compared);

private:
    Parameters prior(bool rested) const;

    std::size_t count_;
    Allowed allowed_;
    Parameters floor_;  ///< diagonal of F
    std::array<Allowance<parameter_count>, component_count> allowance_;
    std::array<std::array<Parameters, max_instruments>, component_count> learned_;
};

}  // namespace quorient::fdi::field
