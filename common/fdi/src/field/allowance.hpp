#pragma once

#include <Eigen/Core>
#include <cmath>

namespace quorient::fdi::field {

/// What sound sensors may differ by in one direction of the comparison: a covariance P over parameters, lowered by a Kalman filter, and a floor
/// F of what may change without being learned. Every sensor has the same one, since all are of one class and see the same regressors.
template <Eigen::Index Count>
class Allowance {
public:
    using Vector = Eigen::Matrix<double, Count, 1, Eigen::DontAlign>;
    using Matrix = Eigen::Matrix<double, Count, Count, Eigen::DontAlign>;

    /// @param variances  of the parameters before anything is learned
    /// @param floor  diagonal of F
    void begin(const Vector& variances, const Vector& floor)
    {
        covariance_ = variances.asDiagonal();
        floor_ = floor;
    }

    /// phi'(P + F) phi, for a frame's regressors or for sums of them.
    double of(const Vector& regressors) const { return regressors.dot(covariance_ * regressors) + floor_.dot(regressors.cwiseAbs2()); }

    /// Standard deviations of the parameters.
    Vector deviations() const { return (covariance_.diagonal() + floor_).cwiseSqrt(); }

    struct Step {
        Vector gain;   ///< times a residual: what is learned from it
        double limit;  ///< a residual beyond it is learned from as if it were so large
    };

    /// One step of the filter.
    /// @param variance  of one frame's noise
    /// @param colour    times the variance: how many frames' noise is one independent piece of information
    Step learn(const Vector& regressors, double variance, double colour)
    {
        constexpr double largest_step = 2.5;
        const Vector spread = covariance_ * regressors;
        const double known = regressors.dot(spread);
        const Step step{spread / (known + colour * variance), largest_step * std::sqrt(known + variance)};
        covariance_ -= step.gain * spread.transpose();
        covariance_ = ((covariance_ + covariance_.transpose()) / 2).eval();
        return step;
    }

    double variance(Eigen::Index parameter) const { return covariance_(parameter, parameter); }
    void add_variance(Eigen::Index parameter, double variance) { covariance_(parameter, parameter) += variance; }

private:
    Matrix covariance_ = Matrix::Zero();
    Vector floor_ = Vector::Zero();
};

}  // namespace quorient::fdi::field
