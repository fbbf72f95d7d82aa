#pragma once

#include "field/parameters.hpp"

namespace quorient::fdi::field {

/// Two equal one-pole low-passes in a row.
class LowPass {
public:
    double follow(double value, double rate)
    {
        first_ += rate * (value - first_);
        second_ += rate * (first_ - second_);
        return second_;
    }
    void begin_at(double value) { first_ = second_ = value; }

private:
    double first_ = 0;
    double second_ = 0;
};

/// For instruments on a structure that flexes: they agree below 2 Hz alone. The regressors and the deviations, passed through one and the same
/// filter; what has been learned is taken out behind it.
class SlowPart {
public:
    explicit SlowPart(double interval_s);

    void reset();

    struct Input {
        Eigen::Vector3d rate;       ///< consensus [rad/s]
        double acceleration;        ///< the component's [rad/s^2]
        double noise;               ///< standard deviation of one frame [rad/s], of the component
        Eigen::Vector3d rate_noise; ///< each component's
    };

    /// @param deviations  learned differences included
    void add(std::size_t component, const Input& input, InstrumentSet compared, const PerInstrument& deviations);

    const Parameters& regressors(std::size_t component) const { return regressors_[component]; }
    double deviation(std::size_t component, std::size_t m) const { return slow_[component][m]; }

    /// Mean square of the consensus above 2 Hz, over 0.3 s, of all components [(rad/s)^2].
    double vibration() const { return vibration_[0] + vibration_[1] + vibration_[2]; }

    /// How many frames make one independent piece of information at least.
    double colour() const { return colour_; }

private:
    double interval_s_;
    double rate_;
    double colour_;
    std::array<std::array<LowPass, parameter_count>, component_count> regressor_{};
    std::array<std::array<LowPass, max_instruments>, component_count> deviation_{};
    std::array<LowPass, component_count> motion_{};
    std::array<double, component_count> vibration_{};
    std::array<Parameters, component_count> regressors_;
    std::array<PerInstrument, component_count> slow_{};
    std::array<InstrumentSet, component_count> begun_{};
    std::array<bool, component_count> moving_{};
};

}  // namespace quorient::fdi::field
