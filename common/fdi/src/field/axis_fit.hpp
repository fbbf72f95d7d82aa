#pragma once

#include "field/parameters.hpp"

#include <limits>

namespace quorient::fdi::field {

/// What one accused axis makes of the motion that the other instruments agree on, by least squares over all frames since the accusation:
///
///   y = h' omega + bias + error' omega - delay h' alpha + residual
///
/// Errors are taken as coloured: ten frames are one independent piece of information. From the second look on, up to three
/// frames that are far off the fit are counted as spikes and pull at it no more than a large residual does.
class AxisFit {
public:
    /// @param direction  h, unit vector in the common frame
    /// @param least_noise  of one frame [rad/s]
    void begin(const Eigen::Vector3d& direction, double least_noise);

    bool begun() const { return least_noise_ > 0; }
    void forget() { least_noise_ = 0; }

    /// @param measured  y [rad/s]
    /// @param rate, acceleration  omega [rad/s] and alpha [rad/s^2], of the others
    void add(double measured, const Eigen::Vector3d& rate, const Eigen::Vector3d& acceleration);

    struct Estimate {
        double value = 0;
        double sigma = std::numeric_limits<double>::infinity();
    };
    struct Solution {
        Estimate bias;      ///< rad/s
        Estimate gain;      ///< along h: 1 where it is sound
        Estimate delay;     ///< s
        Estimate turned;    ///< angle between h and the direction that the axis measures along [rad]
        double length = 1;  ///< that direction's, 1 where it is sound
        double noise = 0;   ///< one frame's [rad/s]
    };
    const Solution& solution() const { return solution_; }

    std::size_t frames() const { return frames_; }
    std::size_t spikes() const { return spikes_; }
    double mean_spike() const { return spikes_ > 0 ? spike_sum_ / static_cast<double>(spikes_) : 0; }  ///< magnitude [rad/s]
    bool is_constant() const { return frames_ > 1 && least_ == most_; }                                 ///< y has not changed at all
    double last() const { return least_; }                                                              ///< where it is constant

private:
    void solve();

    Eigen::Vector3d direction_ = Eigen::Vector3d::UnitX();
    double least_noise_ = 0;
    Covariance normal_ = Covariance::Zero();
    Parameters moment_ = Parameters::Zero();
    double squares_ = 0;
    Parameters estimate_ = Parameters::Zero();
    Covariance covariance_ = Covariance::Zero();
    double variance_ = std::numeric_limits<double>::infinity();  ///< one frame's, unknown at first
    std::size_t frames_ = 0;
    std::size_t run_ = 0;  ///< frames in a row that are far off
    double run_sum_ = 0;
    std::size_t spikes_ = 0;
    double spike_sum_ = 0;
    double least_ = std::numeric_limits<double>::infinity();
    double most_ = -std::numeric_limits<double>::infinity();
    Solution solution_;
};

}  // namespace quorient::fdi::field
